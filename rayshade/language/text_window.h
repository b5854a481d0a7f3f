// A window on a text of any length, which is read from front to back.
//
// Only so much is held that the line of a message that is not too old can be shown.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace rayshade {

// Reads up to `most` bytes; 0 at the end of the text.
using ReadText = std::function<std::size_t(char* to, std::size_t most)>;

class TextWindow {
 public:
  explicit TextWindow(ReadText read);

  const char* next;                         // unread, up to end()
  const char* end() const { return end_; }  // a NUL stands there, which stops every scan
  std::size_t left() const { return static_cast<std::size_t>(end_ - next); }
  void needAhead(std::size_t count);  // of unread bytes, or the rest of the text; moves what is held

  // Offsets count from the beginning of the text.
  std::uint64_t start() const { return start_; }  // of what is held
  std::uint64_t offsetOf(const char* p) const {
    return start_ + static_cast<std::uint64_t>(p - window_.data());
  }
  const char* at(std::uint64_t offset) const { return window_.data() + (offset - start_); }
  std::string_view text(std::uint64_t offset, std::size_t length) const { return {at(offset), length}; }

 private:
  bool refill();  // false when nothing was left to read

  ReadText read_;
  std::vector<char> window_;
  std::uint64_t start_ = 0;  // offset of window_[0]
  const char* end_;
  bool all_ = false;  // the text has been read to its end
};

}  // namespace rayshade
