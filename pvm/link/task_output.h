// What spawned tasks print comes in pieces and goes to stderr in whole lines.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace rayshade {

class TaskOutput {
 public:
  void add(int task, std::string_view text);
  void end(int task);     // prints what is left of this task's
  void forget(int task);  // another one begins
  void endAll();

 private:
  std::map<int, std::string> unfinishedLine_;  // by task
};

}  // namespace rayshade
