// A picture as a file has it, whatever the format: levels.
//
// A level n is n / most of full light; gamma and colour spaces are not looked at.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rayshade/image/picture_format.h"

namespace rayshade {

struct RasterSize {
  std::int32_t width = 0, height = 0;
  std::int32_t channels = 3;  // 1 gray, 2 gray and alpha, 3 RGB, 4 RGB and alpha
  std::uint32_t most = 255;   // at most 65535
  bool textureUpsideDown =
      false;  // as a texture, its first row is the lowest one: rayshade's rule for generic files

  std::size_t rowLevels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  }
};

// Takes a picture in while a file is read: the size first, then the rows, from the top.
class RasterRows {
 public:
  virtual void begin(const RasterSize& size) = 0;
  virtual void row(std::span<const std::uint16_t> levels) = 0;

 protected:
  ~RasterRows() = default;
};

// All of it in memory.
struct Raster : RasterSize {
  std::vector<std::uint16_t> levels;  // row by row from the top
};

// How many levels there are.  Fails, before memory is taken, unless the file may have so many.
inline std::size_t countLevels(const RasterSize& size, std::size_t most, const std::string& name) {
  const std::size_t count = size.rowLevels() * static_cast<std::size_t>(size.height);
  if (count > most)
    failOn(name,
           "too short for " + std::to_string(size.width) + " by " + std::to_string(size.height) + " pixels");
  return count;
}

// Hands on a picture of which the whole was needed.
inline void handOn(const Raster& raster, RasterRows& to) {
  to.begin(raster);
  for (std::size_t at = 0; at < raster.levels.size(); at += raster.rowLevels())
    to.row(std::span(raster.levels).subspan(at, raster.rowLevels()));
}

}  // namespace rayshade
