// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/optics/surface.h"

namespace rayshade {

Surface blend(const Surface& one, double p, const Surface& other, double q) {
  if (q < kNegligible) return one;
  Surface mixed;
  mixed.ambient = p * one.ambient + q * other.ambient;
  mixed.diffuse = p * one.diffuse + q * other.diffuse;
  mixed.specular = p * one.specular + q * other.specular;
  mixed.body = p * one.body + q * other.body;
  mixed.translucent = p * one.translucent + q * other.translucent;
  mixed.specularPower = p * one.specularPower + q * other.specularPower;
  mixed.reflect = p * one.reflect + q * other.reflect;
  mixed.transparency = p * one.transparency + q * other.transparency;
  mixed.index = p * one.index + q * other.index;
  mixed.extinct = p * one.extinct + q * other.extinct;
  mixed.translucency = p * one.translucency + q * other.translucency;
  mixed.translucentPower = p * one.translucentPower + q * other.translucentPower;
  mixed.noShadow = p < kNegligible ? other.noShadow : one.noShadow && other.noShadow;
  return mixed;
}

void limit(Surface& s) {
  for (Color* color : {&s.ambient, &s.diffuse, &s.specular, &s.body, &s.translucent})
    *color = limited(*color);
  for (double* factor : {&s.specularPower, &s.reflect, &s.transparency, &s.index, &s.translucency})
    *factor = std::clamp(*factor, -kMostLight, kMostLight);
}

}  // namespace rayshade
