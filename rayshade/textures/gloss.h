// A normal that differs from sample to sample, so that mirrors blur.
//
//   gloss g                       1: a perfect mirror; 0: deviations up to 45 degrees along each side
//
// The deviation is uniform in a square upright on the normal; each sample of a pixel takes its own part of it.
// Random also without jitter, as in rayshade.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/textures/texture.h"

namespace rayshade {

struct Gloss {
  double glossiness = 1;

  static constexpr std::string_view keyword = "gloss";
  static constexpr TextureNeeds needs = TextureNeeds::position;
  static constexpr bool makesTransparent = false;
  static constexpr std::string_view examples[] = {"0.95"};

  static std::optional<Gloss> parse(Arguments& in) { return Gloss{in.number()}; }

  const Surface* otherSurface() const { return nullptr; }
  void apply(TextureHit& hit) const {
    const int number = hit.sample % (hit.plan.side * hit.plan.side);
    const std::uint32_t coordinate =
        hit.plan.uses.gloss + 2 * (static_cast<std::uint32_t>(hit.depth) + hit.turn);
    const SquarePoint at =
        hit.plan.inStratum(number, hit.key, coordinate, Dimension::glossX, Dimension::glossY, hit.turn);
    const Basis basis = basisAround(hit.normal);
    hit.normal =
        bend(hit.normal, (1 - glossiness) * ((2 * at.x - 1) * basis.first + (2 * at.y - 1) * basis.second));
  }
};

template <class Archive>
void serialize(Archive& archive, Gloss& g) {
  archive(g.glossiness);
}

}  // namespace rayshade
