// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/program/host_program.h"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>

#include "pvm/link/pvm_link.h"
#include "pvm/link/spawning.h"
#include "pvm/link/virtual_machine.h"
#include "pvm/program/task_render.h"
#include "pvm/schedule/plan.h"
#include "rayshade/base/crew.h"
#include "rayshade/base/memory.h"
#include "rayshade/program/command_line.h"

namespace rayshade {
namespace {

bool regularFile(int descriptor) {
  struct stat status {};
  return fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

// The hosts that there would be; asks a virtual machine that runs, but changes and starts nothing.
std::vector<HostInfo> plannedHosts(const std::vector<HostLine>& lines) {
  std::vector<HostInfo> running;
  if (lookForMachine() == MachineState::alive) {
    const VirtualMachine machine({});
    running = PvmLink().hosts();
  }
  char name[256] = "localhost";
  if (!lines.empty()) gethostname(name, sizeof name - 1);
  return hostsAfterJoining(running, lines, isThisMachine, name);
}

std::vector<HostLine> hostLines(const MachineOptions& options) {
  if (options.hostFile.empty()) return {};
  std::ifstream in(options.hostFile);
  if (!in) throw MachineError(options.hostFile + ": the host file cannot be read");
  return readHostFile(in, options.hostFile);
}

// The memory of hosts as the host file says it; of this machine, if nothing is said, what it has, and what a process may take.
HostMemories memoriesOf(const std::vector<HostLine>& lines, const std::string& ownName) {
  HostMemories memories;
  for (const HostLine& line : lines)
    if (line.memory > 0) memories[isThisMachine(line.name) ? ownName : line.name].machine = line.memory;
  HostMemory& own = memories[ownName];
  if (own.machine == 0) own.machine = memoryOfMachine();
  own.eachTask = memoryLimit();
  return memories;
}

class PvmStage final : public Stage {
 public:
  explicit PvmStage(const MachineOptions& options) : options_(options) {}

  std::vector<HostInfo> planned() override { return plannedHosts(lines()); }
  Machine& start() override {
    machine_.emplace(options_);
    for (const std::string& host : machine_->missingHosts())
      std::fprintf(stderr, "rayshade-host: warning: host %s did not join\n", host.c_str());
    return link_.emplace();
  }
  void end() override {
    link_.reset();
    machine_.reset();
  }
  unsigned cores() override { return coreCount(); }
  HostMemories memories(const std::string& ownName) override { return memoriesOf(lines(), ownName); }
  std::string console() override {
    lines();  // a wrong host file is found before anything is written
    return wasSpawned() && !regularFile(STDOUT_FILENO) ? "the pvm console" : "";
  }

 private:
  const std::vector<HostLine>& lines() {
    if (!lines_) lines_ = hostLines(options_);
    return *lines_;
  }

  const MachineOptions& options_;
  std::optional<std::vector<HostLine>> lines_;
  std::optional<VirtualMachine> machine_;
  std::optional<PvmLink> link_;
};

}  // namespace

int runHostProgram(int argc, char** argv) {
  CLI::App app("rayshade-host - renders a scene with many tasks on a PVM virtual machine", "rayshade-host");
  HostProgramOptions options;
  declareHostOptions(app, options);
  if (const std::optional<int> status = readCommandLine(app, argc, argv)) return *status;
  PvmStage stage(options.machine);
  const int status = runTaskRender("rayshade-host", options, stage);
  if (status != 0 && wasSpawned())
    std::fprintf(stderr, "rayshade-host: names of files that do not begin with / are looked for in %s\n",
                 std::filesystem::current_path().c_str());
  return status;
}

}  // namespace rayshade
