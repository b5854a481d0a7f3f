// The (truncated) cone, without caps.
//
//   cone baseRadius  bx by bz  topRadius  tx ty tz     one radius may be 0                     [object units]
//
// Equal radii make a cylinder.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/shapes/frustum.h"

namespace rayshade {

struct Cone {
  Frustum side;

  static constexpr std::string_view keyword = "cone";
  static constexpr Aliases<> aliases{};
  static constexpr bool flat = false, unbounded = false, solid = false, convex = true;
  static constexpr std::string_view examples[] = {"1  0 0 0  0  0 0 1", "0.5  1 2 3  2  4 -1e2 6",
                                                  "1  0 0 0  1  0 2 0"};

  static std::optional<Cone> parse(Arguments& in) {
    const double baseRadius = in.number();
    const Vec3 base = in.vector();
    const double topRadius = in.number();
    const Vec3 top = in.vector();
    const std::optional<Frustum> side = frustumBetween(base, baseRadius, top, topRadius);
    if (!side) return std::nullopt;
    return Cone{*side};
  }

  Bounds bounds() const { return side.bounds(); }
  double intersect(const LocalRay& ray, double tMin) const { return side.intersect(ray, tMin); }
  ShapePoint pointAt(const LocalRay& ray, double t) const { return side.pointAt(ray, t); }
  SurfaceCoordinates coordinates(const ShapePoint&, Vec3 position) const {
    return side.coordinates(position);
  }
};

template <class Archive>
void serialize(Archive& archive, Cone& c) {
  archive(c.side);
}

}  // namespace rayshade
