// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/compare_pictures.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

namespace rayshade {

std::string difference(const Picture& got, const Picture& expected) {
  char text[200];
  if (got.width != expected.width || got.height != expected.height ||
      got.pixels.size() != expected.pixels.size()) {
    std::snprintf(text, sizeof text, "sizes: got %d x %d with %zu numbers, expected %d x %d with %zu",
                  got.width, got.height, got.pixels.size(), expected.width, expected.height,
                  expected.pixels.size());
    return text;
  }
  std::size_t first = got.pixels.size(), different = 0;
  for (std::size_t i = 0; i < got.pixels.size(); ++i) {
    if (std::bit_cast<std::uint32_t>(got.pixels[i]) == std::bit_cast<std::uint32_t>(expected.pixels[i]))
      continue;
    ++different;
    first = std::min(first, i);
  }
  if (different == 0) return "";
  const std::size_t pixel = first / 3, width = static_cast<std::size_t>(got.width);
  std::snprintf(text, sizeof text,
                "%zu of %zu numbers; first pixel (%zu, %zu) channel %zu: got %.9g, expected %.9g", different,
                got.pixels.size(), pixel % width, pixel / width, first % 3,
                static_cast<double>(got.pixels[first]), static_cast<double>(expected.pixels[first]));
  return text;
}

std::string difference(const std::vector<Picture>& got, const std::vector<Picture>& expected) {
  if (got.size() != expected.size())
    return std::to_string(got.size()) + " frames, expected " + std::to_string(expected.size());
  for (std::size_t i = 0; i < got.size(); ++i)
    if (const std::string d = difference(got[i], expected[i]); !d.empty())
      return "frame " + std::to_string(i) + ": " + d;
  return "";
}

Distance distance(const Picture& a, const Picture& b) {
  Distance result;
  result.sameSize = a.width == b.width && a.height == b.height && a.pixels.size() == b.pixels.size();
  if (!result.sameSize) return result;
  const std::size_t width = static_cast<std::size_t>(a.width), height = static_cast<std::size_t>(a.height);
  const std::size_t columns = width / 4, rows = height / 4;
  std::vector<double> blocks(columns * rows * 3);
  double squares = 0, over = 0;
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      double most = 0;
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const std::size_t i = 3 * (y * width + x) + channel;
        const double d = static_cast<double>(levelOf(a.pixels[i], 1, 255)) -
                         static_cast<double>(levelOf(b.pixels[i], 1, 255));
        most = std::max(most, std::abs(d));
        squares += d * d;
        if (x / 4 < columns && y / 4 < rows) blocks[3 * (y / 4 * columns + x / 4) + channel] += d / 16;
      }
      if (most > 1) ++over;
    }
  const double pixels = static_cast<double>(width * height);
  result.over1 = over / pixels;
  result.rmse = std::sqrt(squares / (3 * pixels));
  double blockSquares = 0;
  for (double d : blocks) blockSquares += d * d;
  result.rmse4 = blocks.empty() ? result.rmse : std::sqrt(blockSquares / static_cast<double>(blocks.size()));
  return result;
}

}  // namespace rayshade
