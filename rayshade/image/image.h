// Pixels of 8 bits a channel, for textures.
//
// Row 0 is where v is 0: the lowest row of a picture.  A channel byte b stands for b / 255; there is no gamma.
//
// What travels with a scene is what an image is and where the program that has read it keeps the pixels, not the pixels: they lie
// once on each machine (shared_bytes.h), and whoever takes in an image that came from elsewhere gives it those of its own machine.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/shared_bytes.h"
#include "rayshade/image/picture_format.h"

namespace rayshade {

enum class ImageId : std::uint64_t {};  // a hash of size and pixels

struct Image {
  ImageId id{};
  std::int32_t width = 0, height = 0;  // at least 1 in an image that was read
  std::int32_t channels = 3;           // 1 gray, 2 gray and alpha, 3 RGB, 4 RGB and alpha
  SharedPlace place;                   // of the pixels, in the process that has read them
  MappedBytes pixels;                  // row by row, `channels` bytes each; null: not here

  const std::uint8_t* pixel(std::int32_t x, std::int32_t y) const {
    return &pixels[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * std::size_t(channels)];
  }
  std::uint64_t bytes() const {
    return std::uint64_t(width) * std::uint64_t(height) * std::uint64_t(channels);
  }
};

inline bool isPossible(const Image& i) {
  const auto isSide = [](std::int32_t side) { return side > 0 && side <= kLongestSide; };
  return isSide(i.width) && isSide(i.height) && i.channels > 0 && i.channels <= 4;
}
inline bool sameSize(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height && a.channels == b.channels;
}

// Without the pixels.
template <class Archive>
void serialize(Archive& archive, Image& i) {
  archive(i.id, i.width, i.height, i.channels, i.place);
  if constexpr (Archive::kReading)
    if (!isPossible(i)) {
      i = {};
      archive.fail();
    }
}

}  // namespace rayshade
