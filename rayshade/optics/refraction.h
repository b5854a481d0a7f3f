// Directions of secondary rays, and Phong's lobe: formulas only.
//
// World space; the normal points towards the side that the ray comes from.  It is unit but for bumped surfaces, whose
// normal rayshade does not always renormalise; then the results are not unit either.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "rayshade/base/color.h"
#include "rayshade/base/elementary.h"
#include "rayshade/base/vec.h"

namespace rayshade {

// d - 2 (d.n) n
inline Vec3 mirrored(Vec3 direction, Vec3 normal) {
  return direction - (2 * dot(direction, normal)) * normal;
}

// Snell: with eta = n1 / n2 and c1 = |d.n|, the cosine behind the surface is sqrt(1 - eta^2 (1 - c1^2)); nothing:
// total reflection.  (1 - c1)(1 + c1) keeps its digits near the critical angle where 1 - c1^2 loses them.
// Source: Heckbert, Derivation of Refraction Formulas, in: Glassner, An Introduction to Ray Tracing, 1989.
inline std::optional<Vec3> refracted(Vec3 direction, Vec3 normal, double n1, double n2) {
  const double eta = n1 / n2;
  const double c1 = std::abs(dot(direction, normal));
  const double squared = 1 - eta * eta * (1 - c1) * (1 + c1);
  if (!(squared >= 0)) return std::nullopt;
  return normalize(eta * direction + (eta * c1 - std::sqrt(squared)) * normal);
}

// Phong's highlight, cos(alpha)^power; no highlight with power 0 (rayshade's rule).  Bounded: where the normal is not unit
// the cosine may be above 1.
inline double phongLobe(double cosine, double power) {
  return power >= 1e-5 && cosine > 0 ? std::min(elementary::pow(cosine, power), kMostLight) : 0.0;
}

}  // namespace rayshade
