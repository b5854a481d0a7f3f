// The torus.
//
//   torus swept tube  x y z  ax ay az                                                         [object units]
//
// A circle of radius `swept` around the centre (x, y, z), across the axis (ax, ay, az), thickened to `tube`.
// With the axis as z and rho^2 = x^2 + y^2: points with (rho - swept)^2 + z^2 = tube^2, or multiplied by the
// same with +swept and so freed of the root, (p.p + swept^2 - tube^2)^2 = 4 swept^2 rho^2.  Along a ray that
// is a quartic.  It is set up at the foot of the perpendicular from the centre, so that its coefficients are
// of the size of the torus wherever the ray comes from.  Only its turning points are used: which side of the
// surface they are on, and the roots between them, comes from the first form, which keeps its accuracy when the
// tube is thin.  tube > swept is the spindle torus, its inner sheet included.
// Source: Hanrahan, A Survey of Ray-Surface Intersection Algorithms, in Glassner, An Introduction to Ray
// Tracing, 1989.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/roots.h"
#include "rayshade/shapes/shape.h"

namespace rayshade {

struct Torus {
  double swept = 1, tube = 0.25;
  Vec3 centre;
  Vec3 axis{0, 0, 1};  // of any length but zero

  static constexpr std::string_view keyword = "torus";
  static constexpr Aliases<> aliases{};
  static constexpr bool flat = false, unbounded = false, solid = true;
  static constexpr std::string_view examples[] = {"1 0.25  0 0 0  0 0 1", "0.5 0.001  7 -5 1e3  1 -2 0.4",
                                                  "0.6 1  0 1 0  0 0 -3"};

  static std::optional<Torus> parse(Arguments& in);
  Bounds bounds() const;
  double intersect(const LocalRay& ray, double tMin) const;
  ShapePoint pointAt(const LocalRay& ray, double t) const;
  SurfaceCoordinates coordinates(const ShapePoint& at, Vec3 position) const;
};

template <class Archive>
void serialize(Archive& archive, Torus& t) {
  archive(t.swept, t.tube, t.centre, t.axis);
}

}  // namespace rayshade
