// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/image_file.h"

#include <algorithm>
#include <stdexcept>

#include "rayshade/image/raster_file.h"

namespace rayshade {
namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 31;

Image imageOf(const Raster& raster) {
  Image image{raster.width, raster.height, raster.channels, {}};
  image.pixels.reserve(raster.levels.size());
  const std::size_t length = raster.levels.size() / static_cast<std::size_t>(raster.height);
  for (std::size_t row = 0; row < raster.levels.size(); row += length) {
    const std::size_t from = raster.textureUpsideDown ? row : raster.levels.size() - length - row;
    for (std::size_t i = from; i < from + length; ++i)
      image.pixels.push_back(
          static_cast<std::uint8_t>((raster.levels[i] * 255u + raster.most / 2) / raster.most));
  }
  return image;
}

}  // namespace

std::variant<Image, FileProblem> decodeImage(std::span<const std::byte> bytes, const std::string& name) {
  try {
    return imageOf(readRaster({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name));
  } catch (const std::runtime_error& problem) {
    return FileProblem{problem.what()};
  }
}

std::variant<Image, FileProblem> readImage(const std::string& fileName) {
  auto bytes = readFile(fileName, kLargestFile);
  if (auto* problem = std::get_if<FileProblem>(&bytes)) return std::move(*problem);
  return decodeImage(std::get<Bytes>(bytes), fileName);
}

}  // namespace rayshade
