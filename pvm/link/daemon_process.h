// PVM's daemon as a child of this process: one that the kernel ends when this process ends, whatever ends it.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <stdexcept>
#include <string>

namespace rayshade {

// One line: what is wrong and what to do.
class MachineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The path of the daemon, or "" when PVM is not installed.
std::string daemonProgram();

// Starts the daemon and waits until a virtual machine is there.  `daemon`: the child, which is to be ended, even if it
// then throws MachineError; 0: there is none.
void startDaemon(const std::string& hostFile, const std::string& ownName, pid_t& daemon);

// Ends it with all its tasks.
void endDaemon(pid_t daemon);

}  // namespace rayshade
