// The sphere.
//
//   sphere radius  x y z          radius > 0, centre (x, y, z)                                 [object units]
//
// Points p with |p - c|^2 = r^2.  Along p = o + t d, |d| = 1, with f = o - c, b = -f.d and the foot
// m = f + b d of the perpendicular:  t = b -+ sqrt(r^2 - m.m).  Not b^2 - f.f + r^2: that cancels for far
// spheres, 24 % wrong answers at 1e8 radii.  The root nearer to the origin comes from the product of both,
// t0 t1 = f.f - r^2, because b - sqrt cancels when the origin is close to the surface.
// Source: Haines, Günther & Akenine-Möller, Precision Improvements for Ray/Sphere Intersection, 2019.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

#include "rayshade/base/elementary.h"
#include "rayshade/shapes/shape.h"

namespace rayshade {

struct Sphere {
  Vec3 centre;
  double radius = 1;

  static constexpr std::string_view keyword = "sphere";
  static constexpr Aliases<> aliases{};
  static constexpr bool flat = false, unbounded = false, solid = true, convex = true;
  static constexpr std::string_view examples[] = {"1  0 0 0", "0.001  -5 1e3 7"};

  static std::optional<Sphere> parse(Arguments& in) {
    const double radius = in.number();
    const Vec3 centre = in.vector();
    if (!(radius > 0)) return std::nullopt;
    return Sphere{centre, radius};
  }

  Bounds bounds() const {
    const Vec3 r{radius, radius, radius};
    return {centre - r, centre + r};
  }

  double intersect(const LocalRay& ray, double tMin) const {
    const Vec3 f = ray.origin - centre;
    const double b = -dot(f, ray.direction);
    const Vec3 foot = f + b * ray.direction;
    const double rr = radius * radius;
    const double quarter = rr - dot(foot, foot);  // a quarter of the squared chord
    if (!(quarter >= 0)) return kNoHit;
    const double outside = dot(f, f) - rr;
    const double far = b + std::copysign(std::sqrt(quarter), b);  // the root of larger magnitude
    // Not beyond the far one: near a tangent `outside` is rounding.
    const double other = far != 0 ? std::clamp(outside / far, -std::abs(far), std::abs(far)) : 0.0;
    const double first = std::min(far, other), second = std::max(far, other);
    return first > tMin ? first : second > tMin ? second : kNoHit;
  }

  ShapePoint pointAt(const LocalRay& ray, double t) const {
    const Vec3 normal = normalize(ray.origin + t * ray.direction - centre);
    const Vec3 position = centre + radius * normal;
    return {position, normal, normal, {}, kRounding * (maxAbs(centre) + radius), 1 / radius};
  }

  // v from the -z pole to the +z pole, u around z from the +x axis.
  SurfaceCoordinates coordinates(const ShapePoint&, Vec3 position) const {
    const Vec3 n = normalize(position - centre);
    constexpr double kPole = 1e-5;  // rayshade's own limit: u is 0 this close to a pole
    const double phi = elementary::acos(std::clamp(-n.z, -1.0, 1.0));
    SurfaceCoordinates at;
    at.v = phi / std::numbers::pi;
    if (at.v >= kPole && at.v <= 1 - kPole) {
      const double theta =
          elementary::acos(std::clamp(n.x / elementary::sin(phi), -1.0, 1.0)) / (2 * std::numbers::pi);
      at.u = n.y > 0 ? theta : 1 - theta;
    }
    at.dpdu = normalize({-n.y, n.x, 0});
    if (at.dpdu == Vec3{}) at.dpdu = {1, 0, 0};
    at.dpdv = normalize(cross(n, at.dpdu));
    return at;
  }
};

template <class Archive>
void serialize(Archive& archive, Sphere& s) {
  archive(s.centre, s.radius);
}

}  // namespace rayshade
