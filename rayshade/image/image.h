// Pixels of 8 bits a channel, for textures.
//
// Row 0 is where v is 0: the lowest row of a picture.  A channel byte b stands for b / 255; there is no gamma.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rayshade {

struct Image {
  std::int32_t width = 0, height = 0;  // at least 1 in an image that was read
  std::int32_t channels = 3;           // 1 gray, 2 gray and alpha, 3 RGB, 4 RGB and alpha
  std::vector<std::uint8_t> pixels;    // row by row, `channels` bytes each

  const std::uint8_t* pixel(std::int32_t x, std::int32_t y) const {
    return &pixels[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * std::size_t(channels)];
  }
};

inline bool isWhole(const Image& i) {
  return i.width > 0 && i.height > 0 && i.channels > 0 && i.channels <= 4 &&
         i.pixels.size() == std::size_t(i.width) * std::size_t(i.height) * std::size_t(i.channels);
}

template <class Archive>
void serialize(Archive& archive, Image& i) {
  archive(i.width, i.height, i.channels, i.pixels);
  if constexpr (Archive::kReading) {
    if (!isWhole(i)) {
      i = {};
      archive.fail();
    }
  }
}

}  // namespace rayshade
