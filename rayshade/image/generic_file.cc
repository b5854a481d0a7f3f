// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/generic_file.h"

#include <algorithm>
#include <charconv>
#include <optional>

namespace rayshade {
namespace {

// Takes a whole number above 0 from the front, with the blanks before it.
std::optional<std::int32_t> takeSide(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  std::int32_t side = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), side);
  if (error != std::errc() || side < 1 || side > kLongestSide) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return side;
}

}  // namespace

void readGeneric(std::string_view content, const std::string& name, RasterRows& to) {
  const auto width = takeSide(content);
  const auto height = width ? takeSide(content) : std::nullopt;
  if (!height)
    failOn(name, "neither PNG, JPEG, PPM, PGM nor Utah RLE, and does not begin with a line `width height`");
  const std::size_t endOfLine = content.find_first_not_of(" \r");
  if (endOfLine == content.npos || content[endOfLine] != '\n')
    failOn(name, "more than width and height in the first line");
  content.remove_prefix(endOfLine + 1);

  RasterSize size;
  size.width = *width;
  size.height = *height;
  size.textureUpsideDown = true;
  const std::size_t count = countLevels(size, content.size(), name);
  to.begin(size);
  std::vector<std::uint16_t> levels(size.rowLevels());
  for (std::size_t at = 0; at < count; at += levels.size()) {
    for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = static_cast<std::uint8_t>(content[at + i]);
    to.row(levels);
  }
}

}  // namespace rayshade
