// Blotches of another surface.
//
//   blotch mix SURFACE            noise above `mix` blends towards the surface, wholly at noise 1
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/noise.h"
#include "rayshade/textures/texture.h"

namespace rayshade {

struct Blotch {
  double mix = 0;
  Surface other;

  static constexpr std::string_view keyword = "blotch";
  static constexpr TextureNeeds needs = TextureNeeds::position;
  static constexpr bool makesTransparent = false;
  static constexpr std::string_view examples[] = {"0.1 diffuse 0.7 0.1 0.1"};

  static std::optional<Blotch> parse(Arguments& in) {
    const double mix = in.number();
    return Blotch{mix, in.surface()};
  }

  const Surface* otherSurface() const { return &other; }
  void apply(TextureHit& hit) const {
    const double n = noise(hit.position);
    if (!(n > mix)) return;
    const double share = std::min(1.0, (n - mix) / (1 - mix));  // differs from rayshade4: never above 1
    hit.surface = blend(hit.surface, 1 - share, other, share);
  }
};

template <class Archive>
void serialize(Archive& archive, Blotch& b) {
  archive(b.mix, b.other);
}

}  // namespace rayshade
