// Pretend hosts NAME1, NAME2 ... (hosts/lab) and PVM on them.  They need root.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iterator>
#include <memory>
#include <sstream>

#include "tests/support/program.h"

namespace rayshade {

class Lab {
 public:
  Lab(const std::string& name, const std::string& scratch) : name_(name), scratch_(scratch) {}
  Lab(const Lab&) = delete;
  Lab& operator=(const Lab&) = delete;
  ~Lab() { run("down"); }

  Finished run(const std::string& command) { return begin(command)->wait(60); }
  std::unique_ptr<Program> begin(const std::string& command) const {
    std::istringstream in("hosts/lab " + command);
    return std::make_unique<Program>(std::vector<std::string>{std::istream_iterator<std::string>(in), {}},
                                     scratch_, Program::Environment{{"RAYSHADE_LAB", name_}});
  }
  const std::string& name() const { return name_; }
  std::string host(int number) const { return name_ + std::to_string(number); }
  // A task of that host has work.
  bool busy(int number) const {
    for (const pid_t pid : processesWith("PVM_TMP=/tmp/rayshade-" + name_ + "/" + host(number)))
      if (cpuSecondsOf(pid).value_or(0) > 0.1) return true;
    return false;
  }

 private:
  std::string name_, scratch_;
};

}  // namespace rayshade
