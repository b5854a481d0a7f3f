// Looking along a ray: the plane of the picture in which watertight tests are made.
//
// Space is sheared so that the ray is the third axis and its origin is zero.  A vertex goes to a point (x, y)
// that depends on the vertex and the ray alone, and the turn of an edge around the ray is computed with its
// exact sign; so all faces that share an edge agree on which side of it the ray passes.
// Source: Woop, Benthin & Wald, Watertight Ray/Triangle Intersection, JCGT 2(1), 2013.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "rayshade/optics/ray.h"

namespace rayshade {

struct ShearedPoint {
  double x = 0, y = 0;  // beside the ray                                                     [object units]
  double depth = 0;     // along the ray: a t
};

// The shear for rays whose direction is largest along `axis`.
template <int axis>
class Shear {
 public:
  explicit Shear(const LocalRay& ray)
      : origin_(ray.origin),
        perDepth_(1 / component<axis>(ray.direction)),
        slopeX_(component<kX>(ray.direction) * perDepth_),
        slopeY_(component<kY>(ray.direction) * perDepth_) {}

  ShearedPoint operator()(Vec3 p) const {
    const Vec3 from = p - origin_;
    const double z = component<axis>(from);
    return {component<kX>(from) - slopeX_ * z, component<kY>(from) - slopeY_ * z, z * perDepth_};
  }

 private:
  static constexpr int kX = (axis + 1) % 3, kY = (axis + 2) % 3;

  template <int which>
  static double component(const Vec3& v) {
    if constexpr (which == 0) return v.x;
    if constexpr (which == 1) return v.y;
    if constexpr (which == 2) return v.z;
  }

  Vec3 origin_;
  double perDepth_, slopeX_, slopeY_;
};

// Calls use(shear) with the shear of this ray.
template <class Use>
auto lookAlong(const LocalRay& ray, Use&& use) {
  switch (dominantAxis(ray.direction)) {
    case 0:
      return use(Shear<0>(ray));
    case 1:
      return use(Shear<1>(ray));
    default:
      return use(Shear<2>(ray));
  }
}

// Twice the area of (ray, a, b): positive when the edge from a to b turns left around the ray, zero when the
// ray meets the line of the edge.  turn(b, a) is exactly -turn(a, b).  The difference of two rounded products
// has the right sign unless they are equal; then the difference of their rounding errors has it.
inline double turn(const ShearedPoint& a, const ShearedPoint& b) {
  const double left = a.x * b.y, right = a.y * b.x;
  if (left != right) [[likely]]
    return left - right;
  return std::fma(a.x, b.y, -left) - std::fma(a.y, b.x, -right);
}
// The same, right to the last digits also where the products nearly cancel.
// Source: Kahan; error at most 1.5 ulp: Jeannerod, Louvet & Muller 2013, Further analysis of Kahan's algorithm.
inline double turnToTheLastDigit(const ShearedPoint& a, const ShearedPoint& b) {
  const double right = a.y * b.x;
  return std::fma(a.x, b.y, -right) + std::fma(-a.y, b.x, right);
}

}  // namespace rayshade
