// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/netpbm_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>

namespace rayshade {
namespace {

// The bytes of a file from front to back.
class Cursor {
 public:
  Cursor(std::string_view left, const std::string& name) : left_(left), name_(name) {}

  std::string_view word() {  // netpbm: words between blanks and comments
    for (;;) {
      const std::size_t begin = left_.find_first_not_of(kBlanks);
      if (begin == left_.npos) failOn(name_, "ends too early");
      left_.remove_prefix(begin);
      if (left_[0] != '#') break;
      left_.remove_prefix(std::min(left_.find('\n'), left_.size()));
    }
    const std::size_t end = std::min(left_.find_first_of(kBlanks), left_.size());
    const std::string_view result = left_.substr(0, end);
    left_.remove_prefix(end);
    return result;
  }
  std::int32_t number(std::int32_t least, std::int32_t most) {
    const std::string_view text = word();
    std::int32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value < least || value > most)
      failOn(name_, "a bad number: " + std::string(text.substr(0, 20)));
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

// The levels behind a header, `size` bytes each with the high one first.
void readBytes(const RasterSize& raster, std::string_view bytes, const std::string& name, RasterRows& to) {
  const std::size_t size = raster.most > 255 ? 2 : 1;
  const std::size_t count = countLevels(raster, bytes.size() / size, name);
  to.begin(raster);
  std::vector<std::uint16_t> levels(raster.rowLevels());
  for (std::size_t at = 0; at < count; at += levels.size()) {
    const auto* const from = reinterpret_cast<const unsigned char*>(bytes.data()) + at * size;
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const std::uint32_t level = size == 1 ? from[i] : std::uint32_t{from[2 * i]} << 8 | from[2 * i + 1];
      levels[i] = static_cast<std::uint16_t>(std::min(level, raster.most));
    }
    to.row(levels);
  }
}

void readWords(const RasterSize& raster, Cursor& cursor, const std::string& name, RasterRows& to) {
  const std::size_t count = countLevels(raster, cursor.afterBlank().size(), name);
  to.begin(raster);
  std::vector<std::uint16_t> levels(raster.rowLevels());
  for (std::size_t at = 0; at < count; at += levels.size()) {
    for (std::uint16_t& level : levels)
      level = static_cast<std::uint16_t>(cursor.number(0, static_cast<std::int32_t>(raster.most)));
    to.row(levels);
  }
}

}  // namespace

void readNetpbm(std::string_view content, const std::string& name, RasterRows& to) {
  Cursor cursor(content, name);
  const std::string_view kind = cursor.word();
  if (kind.size() != 2) failOn(name, "no blank behind " + std::string(kind.substr(0, 2)));
  RasterSize raster;
  raster.channels = kind[1] == '2' || kind[1] == '5' ? 1 : 3;
  raster.width = cursor.number(1, kLongestSide);
  raster.height = cursor.number(1, kLongestSide);
  raster.most = static_cast<std::uint32_t>(cursor.number(1, 65535));
  if (kind[1] == '2' || kind[1] == '3')
    readWords(raster, cursor, name, to);
  else
    readBytes(raster, cursor.afterBlank(), name, to);
}

Picture readPfm(std::string_view content, const std::string& name) {
  Cursor header(content, name);
  header.word();  // PF
  Picture picture;
  picture.width = header.number(1, kLongestSide);
  picture.height = header.number(1, kLongestSide);
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
