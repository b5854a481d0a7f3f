// How a program ends: with a status and one message, or by the signal that has interrupted it.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
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
// come back.  `memory`: when there is not enough, what it was for and what is known of the need.
int runProgram(const std::string& program, const std::function<int()>& work,
               const std::function<std::string()>& memory);

// For such messages: 17 objects (1.2 MB), and: the process has 34.5 MB.
std::string objectsAndBytes(std::uint64_t objects, std::uint64_t bytes);
std::string memoryOfProcess();

}  // namespace rayshade
