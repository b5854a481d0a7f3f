// The infinite plane.
//
//   plane  px py pz  nx ny nz     through p, normal to n                                       [object units]
//
// Points q with n.(q - p) = 0.  Along q = o + t d:  t = n.(p - o) / n.d; only n.d = 0 misses.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/shapes/shape.h"

namespace rayshade {

// The t at which a ray meets the plane through `point`, or kNoHit when it is parallel.  The sign of t is not
// looked at.
inline double meetPlane(const LocalRay& ray, Vec3 point, Vec3 normal) {
  const double slope = dot(normal, ray.direction);
  // differs from rayshade4: a grazing ray (|n.d| < 1e-5) hits.
  if (slope == 0) return kNoHit;
  return dot(normal, point - ray.origin) / slope;
}

// A point near the plane through `point`, moved onto it; `normal` is of length 1.
inline ShapePoint ontoPlane(Vec3 along, Vec3 point, Vec3 normal) {
  const Vec3 position = along - normal * dot(normal, along - point);
  return {position, normal, normal, {}, kRounding * (maxAbs(along) + maxAbs(point))};
}

struct Plane {
  Vec3 point;
  Vec3 normal{0, 0, 1};  // unit

  static constexpr std::string_view keyword = "plane";
  static constexpr Aliases<> aliases{};
  static constexpr bool flat = false, unbounded = true, solid = true;
  static constexpr std::string_view examples[] = {"0 0 0  0 0 1", "1 -2 3e4  1 2 -0.5"};

  static std::optional<Plane> parse(Arguments& in) {
    const Vec3 point = in.vector(), normal = in.vector();
    // differs from rayshade4: a normal may be as short as you like, but not zero; numbers must be finite.
    if (normal == Vec3{} || !isFinite(point) || !isFinite(normal)) return std::nullopt;
    return Plane{point, normalize(normal)};
  }

  Bounds bounds() const {
    Bounds b = kEverywhere;
    for (int axis = 0; axis < 3; ++axis)  // a plane square to an axis is thin
      if (std::abs(normal[axis]) == 1 && dot(normal, normal) == 1) b.low[axis] = b.high[axis] = point[axis];
    return b;
  }

  double intersect(const LocalRay& ray, double tMin) const {
    const double t = meetPlane(ray, point, normal);
    return t > tMin ? t : kNoHit;
  }

  ShapePoint pointAt(const LocalRay& ray, double t) const {
    return ontoPlane(ray.origin + t * ray.direction, point, normal);
  }

  bool inside(Vec3 p) const { return dot(p - point, normal) < 0; }

  // Distances from the point along two axes in the plane, the first of them level.  They go with the normal
  // of the hit, which looks at the viewer: seen from the back they mirror.
  SurfaceCoordinates coordinates(const ShapePoint& at, Vec3 position) const {
    const Basis axes = basisAround(at.normal);
    const Vec3 from = position - point;
    return {dot(from, axes.first), dot(from, axes.second), axes.first, axes.second};
  }
};

template <class Archive>
void serialize(Archive& archive, Plane& p) {
  archive(p.point, p.normal);
}

}  // namespace rayshade
