// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/netpbm_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>

#include "rayshade/image/picture_format.h"

namespace rayshade {
namespace {

// The bytes of a file from front to back.
class Cursor {
 public:
  Cursor(std::string_view left, const std::string& name) : left_(left), name_(name) {}

  std::string_view word() {  // netpbm: words between blanks and comments
    for (;;) {
      const std::size_t begin = left_.find_first_not_of(kBlanks);
      if (begin == left_.npos) failOn(name_, "ends in its header");
      left_.remove_prefix(begin);
      if (left_[0] != '#') break;
      left_.remove_prefix(std::min(left_.find('\n'), left_.size()));
    }
    const std::size_t end = std::min(left_.find_first_of(kBlanks), left_.size());
    const std::string_view result = left_.substr(0, end);
    left_.remove_prefix(end);
    return result;
  }
  std::int32_t number(std::int32_t most) {
    const std::string_view text = word();
    std::int32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value < 1 || value > most)
      failOn(name_, "bad number in its header");
    return value;
  }
  std::string_view afterBlank() const {  // one blank ends the header
    return left_.empty() ? left_ : left_.substr(1);
  }

 private:
  static constexpr std::string_view kBlanks = " \t\r\n\v\f";
  std::string_view left_;
  const std::string& name_;
};

Picture readLevels(Cursor header, std::optional<std::uint32_t> most, const std::string& name) {
  Picture picture;
  picture.width = header.number(kLongestSide);
  picture.height = header.number(kLongestSide);
  if (!most) most = static_cast<std::uint32_t>(header.number(65535));
  const std::string_view bytes = header.afterBlank();
  const std::size_t size = *most > 255 ? 2 : 1;
  const std::size_t count = countValues(picture, size, bytes.size(), name);
  picture.pixels.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t level = 0;
    for (char byte : bytes.substr(i * size, size)) level = level << 8 | static_cast<std::uint8_t>(byte);
    picture.pixels.push_back(lightOf(std::min(level, *most), *most));
  }
  return picture;
}

}  // namespace

Picture readPpm(std::string_view content, const std::string& name) {
  Cursor header(content, name);
  header.word();  // P6
  return readLevels(header, std::nullopt, name);
}

Picture readGeneric(std::string_view content, const std::string& name) {
  return readLevels(Cursor(content, name), 255, name);
}

Picture readPfm(std::string_view content, const std::string& name) {
  Cursor header(content, name);
  header.word();  // PF
  Picture picture;
  picture.width = header.number(kLongestSide);
  picture.height = header.number(kLongestSide);
  const bool bigEndian = !header.word().starts_with('-');
  const std::string_view bytes = header.afterBlank();
  picture.pixels.resize(countValues(picture, sizeof(float), bytes.size(), name));
  const std::size_t length = static_cast<std::size_t>(picture.width) * 3;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    std::array<char, sizeof(float)> value;
    std::memcpy(value.data(), &bytes[i * sizeof(float)], sizeof(float));
    if (bigEndian) std::ranges::reverse(value);
    const std::size_t row = static_cast<std::size_t>(picture.height) - 1 - i / length;  // from the bottom
    picture.pixels[row * length + i % length] = std::bit_cast<float>(value);
  }
  return picture;
}

}  // namespace rayshade
