// One program with several names: the role of a task is the name under which it was started.
//
//   rayshade-host            from a shell or from the pvm console
//   rayshade-simulate        from a shell: all tasks in this process, in the time of another machine
//   rayshade-voxel-trace     spawned by the host
//   rayshade-pyramid-trace   spawned by the host
//   rayshade-shade           spawned by the host
//
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>

#include "pvm/host/host_task.h"
#include "pvm/link/pvm_link.h"
#include "pvm/link/spawning.h"
#include "pvm/messages/event_loop.h"
#include "pvm/program/host_program.h"
#include "pvm/program/simulate_program.h"
#include "pvm/shade/shade_task.h"
#include "pvm/trace/pyramid_task.h"
#include "pvm/trace/voxel_task.h"
#include "rayshade/base/memory.h"
#include "rayshade/program/run.h"
#include "rayshade/program/version.h"

namespace {

using namespace rayshade;

static_assert(receiveAllMessages<HostTask, VoxelTask, PyramidTask, ShadeTask>());

int sayVersion(std::string_view name) {
  std::printf("%s\n", versionText(std::string(name)).c_str());
  return 0;
}

int startedByHand(std::string_view name) {
  std::fprintf(stderr,
               "%.*s: rayshade-host starts this program, and gives it its work: start rayshade-host\n",
               static_cast<int>(name.size()), name.data());
  return 2;
}

template <class Task>
int runSlave(std::string_view name) {
  if (!wasSpawned()) return startedByHand(name);
  keepMemoryTight();
  PvmLink link;
  if (link.parent() == kNobody) return startedByHand(name);  // from the pvm console
  link.watch(link.parent());                                 // nobody works for the dead
  Task task(link);
  try {
    runTask(task, link);
  } catch (const std::bad_alloc&) {
    std::string message = "not enough memory for this task: " + memoryOfProcess();
    if constexpr (requires { task.share(); })
      message +=
          "; its share of the scene: " + objectsAndBytes(task.share().objects(), task.share().bytes()) +
          " so far";
    throw std::runtime_error(message);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::string_view name = argc > 0 ? argv[0] : "";
  name = name.substr(name.find_last_of('/') + 1);
  try {
    if (name == programName(Role::host)) return runHostProgram(argc, argv);
    if (name == kSimulateProgram) return runSimulateProgram(argc, argv);
    if (argc == 2 && std::string_view(argv[1]) == "--version") return sayVersion(name);
    if (name == programName(Role::voxelTrace)) return runSlave<VoxelTask>(name);
    if (name == programName(Role::pyramidTrace)) return runSlave<PyramidTask>(name);
    if (name == programName(Role::shade)) return runSlave<ShadeTask>(name);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%.*s: %s\n", static_cast<int>(name.size()), name.data(), error.what());
    return 1;
  }
  std::fprintf(stderr, "start this program as rayshade-host; it was called %.*s\n",
               static_cast<int>(name.size()), name.data());
  return 2;
}
