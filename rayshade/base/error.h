// What is wrong with a scene, and where.
//
// SceneError ends the reading of a scene (it carries all messages found up to then); warnings go on.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace rayshade {

struct SourcePlace {
  std::string file;
  std::uint32_t line = 0;    // from 1; 0: the file as a whole
  std::uint32_t column = 0;  // from 1; 0: the line as a whole
};

inline std::string describe(const SourcePlace& place) {
  std::string text = place.file;
  if (place.line != 0) text += ":" + std::to_string(place.line);
  if (place.column != 0) text += ":" + std::to_string(place.column);
  return text;
}

// A line of a scene as a message shows it: what could move a terminal's cursor is replaced.
inline std::string printable(std::string_view line) {
  std::string shown(line);
  for (char& c : shown)
    if (c != '\t' && (c < ' ' || c > '~')) c = '?';
  return shown;
}
// What goes below it, so that a caret stands behind `before`.
inline std::string caretBehind(std::string_view before) {
  std::string line(before);
  for (char& c : line)
    if (c != '\t') c = ' ';
  return line + "^";
}

// Bad input.  what() is complete lines, each `file:line:column: what is wrong`, without a newline at the end.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace rayshade
