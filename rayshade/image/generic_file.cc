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

Raster readGeneric(std::string_view content, const std::string& name) {
  const auto width = takeSide(content);
  const auto height = width ? takeSide(content) : std::nullopt;
  if (!height)
    failOn(name, "neither PNG, JPEG, PPM, PGM nor Utah RLE, and does not begin with a line `width height`");
  const std::size_t endOfLine = content.find_first_not_of(" \r");
  if (endOfLine == content.npos || content[endOfLine] != '\n')
    failOn(name, "more than width and height in the first line");
  content.remove_prefix(endOfLine + 1);

  Raster raster;
  raster.width = *width;
  raster.height = *height;
  raster.textureUpsideDown = true;
  const std::size_t count = countLevels(raster, content.size(), name);
  raster.levels.reserve(count);
  for (const char byte : content.substr(0, count)) raster.levels.push_back(static_cast<std::uint8_t>(byte));
  return raster;
}

}  // namespace rayshade
