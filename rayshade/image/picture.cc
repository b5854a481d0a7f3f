// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/picture.h"

#include <bit>
#include <cmath>

#include "rayshade/base/elementary.h"

namespace rayshade {

void appendRow(Picture& picture, std::span<const Color> row) {
  for (const Color& c : row)
    for (double light : {c.r, c.g, c.b}) picture.pixels.push_back(static_cast<float>(light));
}

std::uint64_t checksum(const Picture& picture) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  auto add = [&hash](std::uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) hash = (hash ^ (word >> shift & 0xff)) * 0x100000001b3u;
  };
  add(static_cast<std::uint32_t>(picture.width));
  add(static_cast<std::uint32_t>(picture.height));
  for (float light : picture.pixels) add(std::bit_cast<std::uint32_t>(light));
  return hash;
}

std::uint32_t levelOf(float light, double gamma, std::uint32_t most) {
  if (!(light >= 0)) return 0;
  const double shown = gamma == 1 ? light : elementary::pow(static_cast<double>(light), 1 / gamma);
  if (shown > 1) return most;
  return shown > 0 ? static_cast<std::uint32_t>(most * shown) : 0;
}

float lightOf(std::uint32_t level, std::uint32_t most) {
  const float light = static_cast<float>(static_cast<double>(level) / most);
  return levelOf(light, 1, most) == level ? light : std::nextafter(light, 2.0f);
}

}  // namespace rayshade
