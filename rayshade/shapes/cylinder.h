// The cylinder, without caps.
//
//   cylinder radius  bx by bz  tx ty tz     around the line from base b to top t               [object units]
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/shapes/frustum.h"

namespace rayshade {

struct Cylinder {
  Frustum side;

  static constexpr std::string_view keyword = "cylinder";
  static constexpr Aliases<> aliases{};
  static constexpr bool flat = false, unbounded = false, solid = false, convex = true;
  static constexpr std::string_view examples[] = {"1  0 0 0  0 0 1", "0.25  1 2 3  -4 1e2 6"};

  static std::optional<Cylinder> parse(Arguments& in) {
    const double radius = in.number();
    const Vec3 base = in.vector(), top = in.vector();
    const std::optional<Frustum> side = frustumBetween(base, radius, top, radius);
    if (!side) return std::nullopt;
    return Cylinder{*side};
  }

  Bounds bounds() const { return side.bounds(); }
  double intersect(const LocalRay& ray, double tMin) const { return side.intersect(ray, tMin); }
  ShapePoint pointAt(const LocalRay& ray, double t) const { return side.pointAt(ray, t); }
  SurfaceCoordinates coordinates(const ShapePoint&, Vec3 position) const {
    return side.coordinates(position);
  }
};

template <class Archive>
void serialize(Archive& archive, Cylinder& c) {
  archive(c.side);
}

}  // namespace rayshade
