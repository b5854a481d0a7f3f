// How a surface treats light: the reflection properties of the rayshade language.
//
// Defaults are those of a surface with at least one component given; `defaultSurface` is what an object
// without any surface gets.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/color.h"

namespace rayshade {

struct Surface {
  Color ambient, diffuse;
  Color specular;             // colour of highlights and filter of reflected rays
  Color body = kWhite;        // filter of transmitted rays and of light that passes in shadows
  Color translucent;          // diffuse colour for light from behind
  double specularPower = 15;  // 0: no highlight
  double reflect = 0;         // times `specular`
  double transparency = 0;    // times `body`
  double index = 1;           // of refraction
  double extinct = 1;         // share of light left after one unit of distance inside
  double translucency = 0;
  double translucentPower = 15;
  bool noShadow = false;  // receives no shadows
};

inline Surface defaultSurface() {
  Surface s;
  s.ambient = {0.1, 0.1, 0.1};
  s.diffuse = {0.6, 0.6, 0.6};
  s.specular = {0.5, 0.5, 0.5};
  s.specularPower = 12;
  return s;
}

// Below this a transparency counts as none (rayshade's EPSILON, here a threshold of light and not of length).
inline constexpr double kNegligible = 1e-5;

// p of one surface and q of another, property by property.
Surface blend(const Surface& one, double p, const Surface& other, double q);

// What textures make of a surface, one after another, is kept far from infinite.
void limit(Surface& surface);

template <class Archive>
void serialize(Archive& archive, Surface& s) {
  archive(s.ambient, s.diffuse, s.specular, s.body, s.translucent, s.specularPower, s.reflect, s.transparency,
          s.index, s.extinct, s.translucency, s.translucentPower, s.noShadow);
}

}  // namespace rayshade
