// Numbers and words to a stream by way of a large buffer: a million spheres in about a second.
//
// Numbers have six significant digits, as the files of the Standard Procedural Databases have.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>

#include "rayshade/base/color.h"
#include "rayshade/base/vec.h"

namespace rayshade::spd {

class TextOutput {
 public:
  TextOutput(std::ostream& out, std::string_view separator) : out_(out), separator_(separator) {
    buffer_.reserve(kBufferSize + 4096);
  }
  TextOutput(const TextOutput&) = delete;
  TextOutput& operator=(const TextOutput&) = delete;
  ~TextOutput() { flush(); }

  // Any mixture of words and values, written one after the other.
  template <class... Parts>
  void write(const Parts&... parts) {
    (append(parts), ...);
    if (buffer_.size() > kBufferSize) flush();
  }
  void flush() {
    out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    buffer_.clear();
  }

 private:
  static constexpr std::size_t kBufferSize = 1 << 16;
  static constexpr int kDigits = 6;

  void append(std::string_view text) { buffer_ += text; }
  void append(char character) { buffer_ += character; }
  void append(double value) {
    char digits[32];
    const double unsignedZero = value == 0 ? 0 : value;
    const auto end =
        std::to_chars(digits, digits + sizeof digits, unsignedZero, std::chars_format::general, kDigits);
    buffer_.append(digits, end.ptr);
  }
  void append(std::uint32_t value) { buffer_ += std::to_string(value); }
  void append(Vec3 v) { three(v.x, v.y, v.z); }
  void append(Color c) { three(c.r, c.g, c.b); }
  void three(double a, double b, double c) {
    append(a), append(separator_);
    append(b), append(separator_);
    append(c);
  }

  std::ostream& out_;
  std::string_view separator_;  // between the three numbers of a vector or colour
  std::string buffer_;
};

}  // namespace rayshade::spd
