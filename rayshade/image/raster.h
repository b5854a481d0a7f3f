// A picture as a file has it, whatever the format: levels.
//
// A level n is n / most of full light; gamma and colour spaces are not looked at.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "rayshade/image/picture_format.h"

namespace rayshade {

struct Raster {
  std::int32_t width = 0, height = 0;
  std::int32_t channels = 3;          // 1 gray, 2 gray and alpha, 3 RGB, 4 RGB and alpha
  std::uint32_t most = 255;           // at most 65535
  std::vector<std::uint16_t> levels;  // row by row from the top
  bool textureUpsideDown =
      false;  // as a texture, its first row is the lowest one: rayshade's rule for generic files
};

// How many levels there are.  Fails, before memory is taken, unless the file may have so many.
inline std::size_t countLevels(const Raster& raster, std::size_t most, const std::string& name) {
  const std::size_t count = static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height) *
                            static_cast<std::size_t>(raster.channels);
  if (count > most)
    failOn(name, "too short for " + std::to_string(raster.width) + " by " + std::to_string(raster.height) +
                     " pixels");
  return count;
}

}  // namespace rayshade
