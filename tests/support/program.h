// Runs a program as a user would, and looks at all that it leaves behind.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/scratch_directory.h"

namespace rayshade {

struct Finished {
  int status = -1;  // of the exit; 128 + signal when one ended it
  bool inTime = true;
  std::string output, errors;  // what it wrote to standard output and standard error
  double seconds = 0;
  long peakKilobytes = 0;
};

// A program that runs; its destructor kills it.  Its standard output and error go to files beside `scratch`.
class Program {
 public:
  using Environment = std::vector<std::pair<std::string, std::string>>;

  // arguments[0] is looked for in the PATH.  `directory`: where it runs; empty: here.
  Program(const std::vector<std::string>& arguments, const std::string& scratch,
          const Environment& environment = {}, const std::string& directory = "");
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program();

  pid_t pid() const { return pid_; }
  bool running();
  // Kills it when the time is over.
  Finished wait(double seconds);

 private:
  pid_t pid_ = 0;
  double begin_ = 0;
  std::string outputFile_, errorFile_;
  std::optional<Finished> done_;
};

// In a child: becomes a program with these variables beside its own, or ends with 127.
[[noreturn]] void becomeProgram(const std::vector<std::string>& arguments,
                                const Program::Environment& environment);

// Where the programs are: $RAYSHADE_BIN, or bin.  Absolute.
std::string programDirectory();

// The living processes in whose environment NAME=VALUE stands, and which run a program of that name (empty: any).
std::vector<pid_t> processesWith(const std::string& nameAndValue, const std::string& program = "");
// Seconds of CPU that a process has used; nothing when it is gone.
std::optional<double> cpuSecondsOf(pid_t pid);

std::string readText(const std::string& file);
std::size_t countLines(const std::string& text);

}  // namespace rayshade
