// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/program/simulate_program.h"

#include "pvm/messages/task_context.h"
#include "pvm/program/task_render.h"
#include "pvm/simulation/timed_machine.h"
#include "rayshade/program/command_line.h"
#include "rayshade/program/option_values.h"

namespace rayshade {
namespace {

class SimulatedStage final : public Stage {
 public:
  std::string machineFile;
  std::uint32_t processors = 0;  // 0: all

  std::vector<HostInfo> planned() override { return machine().hosts(); }
  Machine& start() override { return machine(); }
  unsigned cores() override { return machine().cores(); }
  HostMemories memories(const std::string&) override {
    HostMemories all;
    for (const HostInfo& host : machine().hosts()) all[host.name].machine = spec_.memory;
    return all;
  }
  void hasHost(const HostTask& host) override {
    machine().countHost([&host] {
      Report report;
      addTo(report, host.traffic());
      return report;
    });
  }
  std::string console() override {
    machine();  // wrong files are found before anything is written
    return {};
  }

 private:
  TimedMachine& machine() {
    if (!machine_) {
      spec_ = readMachine(machineFile);
      machine_.emplace(spec_, readUnitCosts(spec_.costs),
                       processors > 0 ? processors : spec_.hosts * spec_.cores);
    }
    return *machine_;
  }

  MachineSpec spec_;
  std::optional<TimedMachine> machine_;
};

}  // namespace

int runSimulateProgram(int argc, char** argv) {
  const std::string name(kSimulateProgram);
  CLI::App app(
      name + " - renders a scene with the tasks of rayshade-host, in the time of a machine that is not there",
      name);
  HostProgramOptions options;
  SimulatedStage stage;
  declareHostOptions(app, options);
  for (const char* real : {"--hosts", "--missing-hosts", "--mixed"}) app.remove_option(app.get_option(real));
  const std::string machine = "The machine";
  app.add_option("--machine", stage.machineFile, "what is simulated: hosts/machines has some")
      ->type_name(kFile)
      ->check(CLI::ExistingFile)
      ->required()
      ->group(machine);
  app.add_option("--processors", stage.processors, "so many of its processors (default: all)")
      ->check(wholeNumberFrom(1, 65536))
      ->group(machine);
  if (const std::optional<int> status = readCommandLine(app, argc, argv)) return *status;
  return runTaskRender(name, options, stage);
}

}  // namespace rayshade
