// The disc.
//
//   disc radius  x y z  nx ny nz     centre (x, y, z), normal to n                             [object units]
//
// Points q of the plane n.(q - c) = 0 with |q - c| <= r.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

#include "rayshade/base/elementary.h"
#include "rayshade/shapes/plane.h"

namespace rayshade {

struct Disc {
  Vec3 centre;
  Vec3 normal{0, 0, 1};  // unit
  double radius = 1;

  static constexpr std::string_view keyword = "disc";
  static constexpr Aliases<> aliases{};
  static constexpr bool flat = true, unbounded = false, solid = false;
  static constexpr std::string_view examples[] = {"1  0 0 0  0 0 1", "1e-4  5 -6 7  1 -1 2"};

  static std::optional<Disc> parse(Arguments& in) {
    const double radius = in.number();
    const Vec3 centre = in.vector(), normal = in.vector();
    // differs from rayshade4: radius and normal may be as small as you like, but not zero.
    const bool finite = std::isfinite(radius) && isFinite(centre) && isFinite(normal);
    if (!(radius > 0) || normal == Vec3{} || !finite) return std::nullopt;
    return Disc{centre, normalize(normal), radius};
  }

  Bounds bounds() const {
    const Vec3 n = normal;
    const Vec3 reach{radius * elementary::hypot(n.y, n.z), radius * elementary::hypot(n.z, n.x),
                     radius * elementary::hypot(n.x, n.y)};
    return {centre - reach, centre + reach};
  }

  double intersect(const LocalRay& ray, double tMin) const {
    const double t = meetPlane(ray, centre, normal);
    if (!(t > tMin) || t == kNoHit) return kNoHit;
    const Vec3 from = ray.origin - centre + t * ray.direction;
    return dot(from, from) <= radius * radius ? t : kNoHit;
  }

  ShapePoint pointAt(const LocalRay& ray, double t) const {
    return ontoPlane(ray.origin + t * ray.direction, centre, normal);
  }

  // v from the centre to the rim.  u is rayshade's own: an angle about z through the origin of the object's
  // space and not through the centre, right only for a level disc around the z axis.
  SurfaceCoordinates coordinates(const ShapePoint&, Vec3 position) const {
    const Vec3 from = position - centre;
    const double distance = length(from);
    const Basis axes = basisAround(normal);
    if (!(distance > 0)) return {0, 0, axes.first, axes.second};
    SurfaceCoordinates at;
    at.v = distance / radius;
    const double cosine = position.x / distance;
    if (std::abs(cosine) > 1) {
      at.u = 0.5;
    } else {
      const double turn = elementary::acos(cosine) / (2 * std::numbers::pi);
      at.u = position.y < 0 ? 1 - turn : turn;
    }
    at.dpdv = from / distance;
    at.dpdu = normalize(cross(normal, at.dpdv));
    return at;
  }
};

template <class Archive>
void serialize(Archive& archive, Disc& d) {
  archive(d.centre, d.normal, d.radius);
}

}  // namespace rayshade
