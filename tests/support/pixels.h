// Images of given pixels, and the pixels of images.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include "rayshade/image/image.h"

namespace rayshade {

using Pixels = std::vector<std::uint8_t>;

inline Image imageOfPixels(std::int32_t width, std::int32_t height, std::int32_t channels,
                           const Pixels& pixels) {
  std::shared_ptr<std::uint8_t[]> copy(new std::uint8_t[pixels.size()]);
  std::copy(pixels.begin(), pixels.end(), copy.get());
  return {ImageId{1}, width, height, channels, {}, copy};
}

inline Pixels pixelsOf(const Image& image) {
  return image.pixels ? Pixels(image.pixels.get(), image.pixels.get() + image.bytes()) : Pixels{};
}

}  // namespace rayshade
