// The axis-aligned box.
//
//   box  x0 y0 z0  x1 y1 z1       any two opposite corners                                     [object units]
//
// Kay & Kajiya's slabs: the ray is inside from the last of its three entries to the first of its three exits.
// Each (face - origin) / direction is right to two roundings, so entry and exit may be swapped by that much
// when the ray touches an edge; such a ray still hits.  Which face was hit is not stored: it is the one whose
// slab parameter is t, computed again by the same expression.
// Source: Kay & Kajiya, Ray Tracing Complex Scenes, 1986; Ize, Robust BVH Ray Traversal, 2013.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/shapes/shape.h"

namespace rayshade {

struct Box {
  Vec3 low{0, 0, 0}, high{1, 1, 1};

  static constexpr std::string_view keyword = "box";
  static constexpr Aliases<> aliases{};
  static constexpr bool flat = false, unbounded = false, solid = true, convex = true;
  static constexpr std::string_view examples[] = {"-1 -1 -1  1 1 1", "3 2 1  0 -1e-4 0"};

  static std::optional<Box> parse(Arguments& in) {
    const Vec3 a = in.vector(), b = in.vector();
    const Box box{{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
                  {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
    // differs from rayshade4: a side may be as short as you like, but not zero; coordinates must be finite.
    const bool solid = box.low.x < box.high.x && box.low.y < box.high.y && box.low.z < box.high.z;
    if (!solid || !isFinite(a) || !isFinite(b)) return std::nullopt;
    return box;
  }

  Bounds bounds() const { return {low, high}; }

  double intersect(const LocalRay& ray, double tMin) const {
    double entry = -kInfinity, exit = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
      const double origin = ray.origin[axis], direction = ray.direction[axis];
      if (direction == 0) {
        if (!(low[axis] <= origin && origin <= high[axis])) return kNoHit;
        continue;
      }
      const double toLow = (low[axis] - origin) / direction, toHigh = (high[axis] - origin) / direction;
      entry = std::max(entry, std::min(toLow, toHigh));
      exit = std::min(exit, std::max(toLow, toHigh));
    }
    constexpr double kSwapped = 0x1p-51;
    if (!(entry <= exit + kSwapped * std::abs(exit))) return kNoHit;
    const double first = std::min(entry, exit), second = std::max(entry, exit);
    return first > tMin ? first : second > tMin ? second : kNoHit;
  }

  ShapePoint pointAt(const LocalRay& ray, double t) const {
    int hitAxis = 0;
    bool hitHigh = true;
    double nearest = kInfinity;  // zero at the face that gave t; the first of +x -x +y -y +z -z at an edge
    for (int axis = 0; axis < 3; ++axis) {
      if (ray.direction[axis] == 0) continue;
      for (const bool isHigh : {true, false}) {
        const double face = isHigh ? high[axis] : low[axis];
        const double distance = std::abs((face - ray.origin[axis]) / ray.direction[axis] - t);
        if (!(distance < nearest)) continue;
        nearest = distance;
        hitAxis = axis;
        hitHigh = isHigh;
      }
    }
    ShapePoint at;
    const Vec3 along = ray.origin + t * ray.direction;
    for (int axis = 0; axis < 3; ++axis)
      at.position[axis] = std::min(std::max(along[axis], low[axis]), high[axis]);
    at.position[hitAxis] = hitHigh ? high[hitAxis] : low[hitAxis];
    at.normal[hitAxis] = hitHigh ? 1 : -1;
    at.geometricNormal = at.normal;
    at.error = kRounding * std::max(maxAbs(low), maxAbs(high));
    return at;
  }

  SurfaceCoordinates coordinates(const ShapePoint&, Vec3) const { return {}; }  // a box has none: u = v = 0
};

template <class Archive>
void serialize(Archive& archive, Box& b) {
  archive(b.low, b.high);
}

}  // namespace rayshade
