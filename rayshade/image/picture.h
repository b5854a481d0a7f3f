// Pictures in memory: linear light, and the levels that files have instead.
//
// Levels are, as in rayshade,
//
//   x' = x^(1/gamma);   below 0 -> 0;   above 1 -> most;   else most * x' without its fraction      most = 255, 65535
//
// and gamma 0 makes all below 1 black.  differs from rayshade4: negative light and what is not a number are
// black whatever the gamma.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rayshade/base/color.h"

namespace rayshade {

struct Picture {
  std::int32_t width = 0, height = 0;
  std::vector<float> pixels;  // red, green, blue; row by row from the top

  friend bool operator==(const Picture&, const Picture&) = default;
};

void appendRow(Picture& picture, std::span<const Color> row);

// Of the size and the bits of the pixels in row order, 64-bit FNV-1a: equal pictures, equal numbers.
std::uint64_t checksum(const Picture& picture);

// The level of linear light, 0..most.
std::uint32_t levelOf(float light, double gamma, std::uint32_t most);
// The smallest float that levelOf() turns into this level, with gamma 1.
float lightOf(std::uint32_t level, std::uint32_t most);

}  // namespace rayshade
