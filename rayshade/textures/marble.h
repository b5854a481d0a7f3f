// Veins of marble across the z axis: scales ambient and diffuse.
//
//   marble [COLORMAP]
//
// With turbulence c of six octaves, the value is ((sin(8 c + 7 z) + 1) / 2)^0.77.
// Source: K. Perlin, An Image Synthesizer, SIGGRAPH 1985; constants: rayshade.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/elementary.h"
#include "rayshade/base/noise.h"
#include "rayshade/textures/colormap.h"
#include "rayshade/textures/texture.h"

namespace rayshade {

struct Marble {
  std::optional<Colormap> colormap;

  static constexpr std::string_view keyword = "marble";
  static constexpr TextureNeeds needs = TextureNeeds::position;
  static constexpr bool makesTransparent = false;
  static constexpr std::string_view examples[] = {""};

  static std::optional<Marble> parse(Arguments& in) {
    Marble marble;
    if (in.fileNameFollows()) marble.colormap = parseColormap(in);
    return marble;
  }

  const Surface* otherSurface() const { return nullptr; }
  void apply(TextureHit& hit) const {
    const double wave = elementary::sin(8 * chaos(hit.position, 6) + 7 * hit.position.z);
    const double value = elementary::pow(0.5 * (wave + 1), 0.77);
    if (colormap)
      scaleAmbientAndDiffuse(hit.surface, colormap->at(255 * value));
    else
      scaleAmbientAndDiffuse(hit.surface, value);
  }
};

template <class Archive>
void serialize(Archive& archive, Marble& m) {
  archive(m.colormap);
}

}  // namespace rayshade
