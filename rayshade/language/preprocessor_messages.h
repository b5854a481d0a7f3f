// What cpp has to say, in the form in which everything else is said of a scene: `file:line:column: error: what is wrong`,
// the line and a caret.
//
// cpp in its traditional way counts a file that it cannot include to the line behind the directive, and gives many messages
// no column.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace rayshade {

struct PreprocessorMessage {
  bool isWarning = false;
  std::string text;      // what is wrong
  std::string complete;  // with its place, without a newline at the end
};

// `said`: all that cpp wrote to its standard error.
std::vector<PreprocessorMessage> preprocessorMessages(const std::string& said);

}  // namespace rayshade
