// Wood with rings around no particular axis: scales ambient and diffuse.
//
//   wood
//
// All constants are rayshade's: a distorted wave makes rings b, a finer one grain t.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/elementary.h"
#include "rayshade/base/noise.h"
#include "rayshade/textures/texture.h"

namespace rayshade {

struct Wood {
  static constexpr std::string_view keyword = "wood";
  static constexpr TextureNeeds needs = TextureNeeds::position;
  static constexpr bool makesTransparent = false;
  static constexpr std::string_view examples[] = {""};

  static std::optional<Wood> parse(Arguments&) { return Wood{}; }

  const Surface* otherSurface() const { return nullptr; }
  void apply(TextureHit& hit) const {
    const Vec3 p = hit.position;
    const double turbulence = chaos(p, 7);
    const double ring = std::abs(elementary::sin(elementary::sin(8 * turbulence + 7 * p.x + 3 * p.y)));
    const double grain = std::abs(elementary::sin(40 * turbulence + 50 * p.z));
    const double dark = 0.5 * elementary::pow(ring, 0.3);
    const double light = elementary::pow(0.5 * (ring + 1), 0.6);
    const double warm = light * (0.6 * grain + 0.3), pale = light * (0.2 * grain + 0.8);
    scaleAmbientAndDiffuse(hit.surface, Color{2 * dark * (0.5 * warm + 0.35 * pale),
                                              dark * std::max(warm, pale) * (0.15 * grain + 0.85),
                                              2 * dark * (0.25 * warm + 0.35 * pale)});
  }
};

template <class Archive>
void serialize(Archive&, Wood&) {}

}  // namespace rayshade
