// Colours of a mountain by height and slope, with z up.
//
//   mount COLORMAP turbulence slope
//
// Entry 256 (z + turbulence c - slope (1 - N.z)) of the map, c being turbulence of seven octaves, scales
// ambient, diffuse and specular.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/noise.h"
#include "rayshade/textures/colormap.h"
#include "rayshade/textures/texture.h"

namespace rayshade {

struct Mount {
  Colormap colormap;
  double turbulence = 0, slope = 0;

  static constexpr std::string_view keyword = "mount";
  static constexpr TextureNeeds needs = TextureNeeds::position;
  static constexpr bool makesTransparent = false;
  static constexpr std::string_view examples[] = {"colors.map 0.5 0.4"};

  static std::optional<Mount> parse(Arguments& in) {
    Mount mount;
    mount.colormap = parseColormap(in);
    mount.turbulence = in.number();
    mount.slope = in.number();
    return mount;
  }

  const Surface* otherSurface() const { return nullptr; }
  void apply(TextureHit& hit) const {
    const double height = hit.position.z + turbulence * chaos(hit.position, 7) - slope * (1 - hit.normal.z);
    const Color color = colormap.at(256 * height);
    scaleAmbientAndDiffuse(hit.surface, color);
    hit.surface.specular = hit.surface.specular * color;
  }
};

template <class Archive>
void serialize(Archive& archive, Mount& m) {
  archive(m.colormap, m.turbulence, m.slope);
}

}  // namespace rayshade
