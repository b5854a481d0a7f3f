// What is wrong with a scene: the messages, each with its place, its line and a caret.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/language/tokens.h"

namespace rayshade {

// Thrown when there is no point in looking for more that is wrong.
struct Enough {};

class FaultLog {
 public:
  using Warn = std::function<void(const std::string&)>;  // takes complete messages; may be empty

  FaultLog(Tokens& tokens, const Warn& warn) : tokens_(tokens), warn_(warn) {}

  void warn(const TokenPlace& place, const std::string& text);
  // Throws Enough when that was the last that is worth telling.
  void add(const Fault& fault);

  const std::string& errors() const { return errors_; }  // all of them, in order
  // Is this where the last one was?
  bool wasAt(const TokenPlace& place) const { return place.offset == wrong_; }

 private:
  std::string message(const TokenPlace& place, std::string_view kind, const std::string& text);

  Tokens& tokens_;
  const Warn& warn_;
  std::string errors_;
  int count_ = 0;
  std::uint64_t wrong_ = 0;  // offset of the last token that was no good
};

}  // namespace rayshade
