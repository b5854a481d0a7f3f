// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/spawning.h"

#include <pvm3.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "pvm/link/daemon_files.h"

namespace rayshade {
namespace {

std::string whyNotStarted(int code) {
  switch (code) {
    case PvmNoHost:
      return "no such host in the virtual machine";
    case PvmOutOfRes:
      return "the host has no room for another task: its daemon needs two open files for each (ulimit -n)";
    case PvmNoMem:
      return "the host has not enough memory";
    case PvmHostFail:
      return "the host failed";
    case PvmDSysErr:
      return "the daemon there could not start it";
    default:
      return "PVM says error " + std::to_string(code);
  }
}

}  // namespace

Command usualCommand(Role role) {
  const char* given = std::getenv("RAYSHADE_TASKS");
  std::error_code ignored;
  const std::filesystem::path directory =
      given && *given ? std::filesystem::path(given)
                      : std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  return {(directory / programName(role)).string()};
}

Spawned spawnTask(Daemon& daemon, Command command, const std::string& host) {
  const std::filesystem::path program = command.at(0);
  std::vector<char*> arguments;
  for (std::size_t i = 1; i < command.size(); ++i) arguments.push_back(command[i].data());
  arguments.push_back(nullptr);
  std::string where = host.empty() ? "." : host;
  const auto start = [&](std::string name) {
    int task = 0;
    const int result =
        daemon.check(pvm_spawn(name.data(), arguments.data(), PvmTaskHost, where.data(), 1, &task), "spawn");
    return result == 1 ? task : result < 0 ? result : task;
  };
  int task = start(program.string());
  if (task == PvmNoFile) task = start(program.filename().string());
  if (task > 0) return {TaskId{task}, ""};
  const std::string named = host.empty() ? "here" : host;
  if (task != PvmNoFile)
    return {kNobody, program.string() + " on host " + named + ": " + whyNotStarted(task)};
  return {
      kNobody,
      "host " + named + " has neither " + program.string() + " nor " + program.filename().string() +
          " in its search path (ep= in the host file, or PVM_PATH): build it there, or set RAYSHADE_TASKS"};
}

bool wasSpawned() { return !environment("PVMEPID").empty(); }

int endTask(TaskId task) {
  pvm_kill(number(task));
  return pvm_sendsig(number(task), SIGKILL);
}

}  // namespace rayshade
