// Bends the normal by vector noise.
//
//   bump size
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/noise.h"
#include "rayshade/textures/texture.h"

namespace rayshade {

struct Bump {
  double size = 0;

  static constexpr std::string_view keyword = "bump";
  static constexpr TextureNeeds needs = TextureNeeds::position;
  static constexpr bool makesTransparent = false;
  static constexpr std::string_view examples[] = {"0.6"};

  static std::optional<Bump> parse(Arguments& in) { return Bump{in.number()}; }

  const Surface* otherSurface() const { return nullptr; }
  void apply(TextureHit& hit) const { hit.normal = bend(hit.normal, size * vectorNoise(hit.position)); }
};

template <class Archive>
void serialize(Archive& archive, Bump& b) {
  archive(b.size);
}

}  // namespace rayshade
