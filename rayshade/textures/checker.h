// Checkerboard in three dimensions.
//
//   checker SURFACE               cells of size 1: scale the texture for others
//
// A coordinate c lies in cell int(c) if c > 0, else in cell int(1 - c); where the three cells add up to an
// odd number, the surface is replaced.  So 0 itself belongs to cell 1, and a plane at 0 is noisy, as in
// rayshade.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/textures/texture.h"

namespace rayshade {

struct Checker {
  Surface odd;

  static constexpr std::string_view keyword = "checker";
  static constexpr TextureNeeds needs = TextureNeeds::position;
  static constexpr bool makesTransparent = false;
  static constexpr std::string_view examples[] = {"diffuse 0.1 0.1 0.1"};

  static std::optional<Checker> parse(Arguments& in) { return Checker{in.surface()}; }

  const Surface* otherSurface() const { return &odd; }
  void apply(TextureHit& hit) const {
    // The parity of a cell's number, also where it does not fit an integer.
    auto parity = [](double c) { return std::fmod(std::trunc(c > 0 ? c : 1 - c), 2) != 0; };
    if (parity(hit.position.x) ^ parity(hit.position.y) ^ parity(hit.position.z)) hit.surface = odd;
  }
};

template <class Archive>
void serialize(Archive& archive, Checker& c) {
  archive(c.odd);
}

}  // namespace rayshade
