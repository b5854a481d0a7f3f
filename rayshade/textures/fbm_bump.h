// Adds vector-valued fractional Brownian motion to the normal.
//
//   fbmbump offset scale H lambda octaves
//
// The normal is left as long as it becomes: in rayshade only a transformed object gives it length 1 again.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/noise.h"
#include "rayshade/textures/fractal.h"
#include "rayshade/textures/texture.h"

namespace rayshade {

struct FbmBump {
  double offset = 0, scale = 1;
  Spectrum spectrum;

  static constexpr std::string_view keyword = "fbmbump";
  static constexpr TextureNeeds needs = TextureNeeds::position;
  static constexpr bool makesTransparent = false;
  static constexpr std::string_view examples[] = {"0 0.7 0.5 2 5"};

  static std::optional<FbmBump> parse(Arguments& in) {
    FbmBump bump;
    bump.offset = in.number(kFactor);
    bump.scale = in.number(kFactor);
    bump.spectrum = parseSpectrum(in);
    return bump;
  }

  const Surface* otherSurface() const { return nullptr; }
  void apply(TextureHit& hit) const {
    const Vec3 bumped =
        hit.normal + Vec3{offset, offset, offset} + scale * vectorFractionalMotion(hit.position, spectrum);
    if (isFinite(bumped) && bumped != Vec3{}) hit.normal = bumped;
  }
};

template <class Archive>
void serialize(Archive& archive, FbmBump& b) {
  archive(b.offset, b.scale, b.spectrum);
}

}  // namespace rayshade
