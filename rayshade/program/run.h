// How a program ends: with a status and one message, or by the signal that has interrupted it.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace rayshade {

// What is asked for makes no sense, whatever is in the files: exit status 2.
class CommandLineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Does the work and gives the exit status.  Whatever it throws becomes a message; when it was interrupted, it does not
// come back.
int runProgram(const std::string& name, const std::function<int()>& work);

}  // namespace rayshade
