// Starting tasks on machines of the virtual machine, and ending them.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/link/daemon.h"

namespace rayshade {

// The program of a role and its arguments.
using Command = std::vector<std::string>;

// RAYSHADE_TASKS/name, else name beside the program that runs now.
Command usualCommand(Role role);

// On a host, or "": on this machine.  Where the program is not at its path, the host's own search path counts.
Spawned spawnTask(Daemon& daemon, Command command, const std::string& host);

// Was this process started by a daemon, and not from a shell?
bool wasSpawned();

// A task that hangs may have been stopped, and then a signal that can be waited with does not end it.  Answers what libpvm
// does.
int endTask(TaskId task);

}  // namespace rayshade
