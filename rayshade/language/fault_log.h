// What is wrong with a scene: the messages, each with its place, its line and a caret.
//
// A kind of warning is said three times, then counted: a mesh may deserve thousands of the same.  Warnings are of one kind
// when they differ only in numbers and in what stands in `quotes`.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "rayshade/language/tokens.h"

namespace rayshade {

inline constexpr int kMostErrors = 20;  // that are worth telling

// Thrown when there is no point in looking for more that is wrong.
struct Enough {};

class FaultLog {
 public:
  using Warn = std::function<void(const std::string&)>;  // takes complete messages; may be empty

  FaultLog(Tokens& tokens, const Warn& warn) : tokens_(tokens), warn_(warn) {}

  void warn(const TokenPlace& place, const std::string& text);
  // Somebody else's: `message` is complete, `text` what it says.
  void warn(const std::string& text, const std::string& message);
  // Throws Enough when that was the last that is worth telling.
  void add(const Fault& fault);
  // Says how many warnings were only counted.
  void finish();

  const std::string& errors() const { return errors_; }  // all of them, in order
  // Is this where the last one was?
  bool wasAt(const TokenPlace& place) const { return place.offset == wrong_; }

 private:
  struct Kind {
    std::uint64_t count = 0;
    std::string first;  // the text of the first one
  };

  bool worthSaying(const std::string& text);
  std::string message(const TokenPlace& place, std::string_view kind, const std::string& text);

  Tokens& tokens_;
  const Warn& warn_;
  std::map<std::string, Kind> kinds_;  // of warnings, by their fixed text
  std::string errors_;
  int count_ = 0;
  std::uint64_t wrong_ = 0;  // offset of the last token that was no good
};

}  // namespace rayshade
