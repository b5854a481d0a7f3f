// A program that talks on a terminal, as PVM's console does: typed to and listened to through a pseudo-terminal.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/support/program.h"

namespace rayshade {

class Console {
 public:
  Console(const std::vector<std::string>& arguments, const Program::Environment& environment);
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;
  ~Console();  // kills it

  void type(const std::string& line);
  // Listens until `text` has been said, after what was heard before.  What was said, without it if the time is over.
  std::string hear(const std::string& text, double seconds);
  bool ends(double seconds);

 private:
  bool read(double seconds);  // false: nothing came, or it has ended

  pid_t pid_ = 0;
  int terminal_ = -1;
  std::string heard_;  // and not asked for yet
};

}  // namespace rayshade
