// The side of a round frustum: what cylinder and cone have in common.  Open at both ends.
//
// Points at height z along the axis, 0 <= z <= length, whose distance from it is R(z) = r + k z.  With f and e
// the parts of origin - base and direction square to the axis, F = R at the origin's height and E = k (d.axis):
//   A t^2 + 2 B t + C = 0,  A = e.e - E^2,  B = f.e - F E,  C = f.f - F^2,
//   B^2 - A C = |F e - E f|^2 - |f x e|^2
// (the product of the planes, Lagrange's identity in one more dimension; B^2 - A C as written cancels for far
// rays).  The root nearer to the origin comes from the product of both.  The mirror image of the cone beyond
// its apex has z < 0 and so is never met.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/shapes/shape.h"

namespace rayshade {

struct Frustum {
  Vec3 base;           // centre of the small end                                              [object units]
  Vec3 axis{0, 0, 1};  // unit, from the small end to the large one
  double length = 1;
  double radius = 1;     // of the small end
  double endRadius = 1;  // of the large end

  Bounds bounds() const;
  double intersect(const LocalRay& ray, double tMin) const;
  ShapePoint pointAt(const LocalRay& ray, double t) const;
  // u around the axis, v from the small end to the large one; the tangents likewise.
  SurfaceCoordinates coordinates(Vec3 position) const;

  double growth() const { return (endRadius - radius) / length; }

 private:
  template <bool alongGenerator>
  double nearest(const LocalRay& ray, double tMin) const;
  double improved(double root, Vec3 from, Vec3 direction, double between) const;
};

// Nothing when there is no side: no length, a negative radius, both radii zero, a number that is not finite.
std::optional<Frustum> frustumBetween(Vec3 base, double baseRadius, Vec3 top, double topRadius);

template <class Archive>
void serialize(Archive& archive, Frustum& f) {
  archive(f.base, f.axis, f.length, f.radius, f.endRadius);
}

}  // namespace rayshade
