// Ctrl-C, SIGTERM and SIGHUP as a question that a loop can ask, so that files and tasks are put away in order.
//
// A signal that was ignored when the program began stays ignored (nohup; a background job of a script).  The second one
// ends the program at once.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace rayshade {

class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

void listenForInterruption();

// Has a signal come?
bool interrupted();
std::string interruptionText();  // interrupted by SIGINT

// Throws Interrupted when a signal has come.
void checkInterruption();

// Dies of the signal that has come, so that whoever started the program (a shell with a loop over scenes) knows.  Nothing is
// put away any more.
[[noreturn]] void dieOfInterruption();

}  // namespace rayshade
