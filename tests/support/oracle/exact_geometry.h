// Where a line meets each shape, and how far a point of the line is from it, in any number type.
//
// The plain definitions of the surfaces, written for clearness and not for speed: with Exact (256 bits) their rounding
// is far below everything that is asked of doubles; with long double they are a quick first look.  What a shape stores
// is taken as exact, but for unit vectors, which are of length 1 here.
//
// A shape is one or several parts.  Of a part are asked
//   crossings   the t at which the line meets its carrier: the surface without its rim (a plane for a triangle, an
//               endless cone for a cone)
//   siteAt      for a point of the line: its distance from the carrier, with a sign that changes where it is crossed;
//               how squarely the line goes there, |n.d|; how far beyond the rim the point is, along the surface
//
// Sources: the formulas of the headers in rayshade/shapes, as definitions; roots of quartics lie between those of their
// derivatives (Rolle).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/support/oracle/exact_flats.h"
#include "tests/support/oracle/exact_solids.h"

namespace rayshade::exact {

// The parts of a shape; most are one.
template <class S>
std::vector<S> partsOf(const S& shape) {
  return {shape};
}
inline std::vector<Triangle> partsOf(const PhongTriangle& shape) { return {shape.face}; }
inline std::vector<Triangle> partsOf(const TriangleUv& shape) { return {shape.phong.face}; }
inline std::vector<Triangle> partsOf(const HeightField& shape) {
  const Heights& h = *shape.heights;
  const auto corner = [&](int x, int y) {
    const double cells = h.size - 1;
    return Vec3{x / cells, y / cells, h.values[static_cast<std::size_t>(y * h.size + x)]};
  };
  std::vector<Triangle> triangles;
  for (int y = 0; y + 1 < h.size; ++y)
    for (int x = 0; x + 1 < h.size; ++x) {
      triangles.push_back({{corner(x, y), corner(x + 1, y), corner(x, y + 1)}});
      triangles.push_back({{corner(x + 1, y + 1), corner(x, y + 1), corner(x + 1, y)}});
    }
  return triangles;
}

}  // namespace rayshade::exact
