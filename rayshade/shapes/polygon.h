// The plane polygon: convex or not, also one that crosses itself.
//
//   polygon  p1 p2 p3 ...         three corners or more                                        [object units]
//
// The plane goes through p1 with Newell's normal, or where its sum cancels with that of a large triangle of corners;
// the front is the side from which the corners run counter-clockwise.  The ray is inside when the outline, seen along the ray (shear.h), winds around it a
// number of times that is not zero, or passes through it exactly; so polygons that share an edge do not leak.
// t is that of the plane, but not beyond the extent of the corners and their places in the plane: that matters
// when the corners are not quite in a plane and the ray grazes it.  When they are visibly not in a plane, corners and hit are projected
// along the largest component of the normal, as rayshade does, because that is how such pictures look.
// Source: Newell's method as in Sutherland, Sproull & Schumacker, 1974; winding number: Sunday, 2001.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "rayshade/shapes/outline.h"
#include "rayshade/shapes/shape.h"

namespace rayshade {

struct Polygon {
  std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  Vec3 normal{0, 0, 1};  // unit
  bool bent = false;     // the corners are visibly not in one plane
  // What follows from these, see prepare().
  Bounds extent{{0, 0, 0}, {1, 1, 0}};
  std::shared_ptr<const Outline> outline = nullptr;  // of polygons with many corners

  static constexpr std::string_view keyword = "polygon";
  static constexpr Aliases<1> aliases{"poly"};
  static constexpr bool flat = true, unbounded = false, solid = false;
  static constexpr std::string_view examples[] = {"0 0 0  1 0 0  0 1 0", "0 0 1  4 0 1  4 4 1  2 1 1  0 4 1"};

  static std::optional<Polygon> parse(Arguments& in);

  void prepare();  // computes extent and outline
  Bounds bounds() const { return extent; }
  double intersect(const LocalRay& ray, double tMin, double tMax = kNoHit) const;
  ShapePoint pointAt(const LocalRay& ray, double t) const;
  SurfaceCoordinates coordinates(const ShapePoint&, Vec3 position) const {
    SurfaceCoordinates at;  // x and y of object space, whatever the plane
    at.u = position.x;
    at.v = position.y;
    return at;
  }

  Polygon flipped() const;  // for option -f

 private:
  bool inside(const LocalRay& ray, double t) const;
};

template <class Archive>
void serialize(Archive& archive, Polygon& p) {
  archive(p.corners, p.normal, p.bent);
  if constexpr (Archive::kReading) {
    if (p.corners.size() < 3) {
      p = {};
      archive.fail();
    }
    p.prepare();
  }
}

}  // namespace rayshade
