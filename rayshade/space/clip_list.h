// Pyramids of rays, and the cells that they may touch (Reinhard & Jansen, section 4, figure 4).
//
// A pyramid has an apex and four sides; all its rays start at the apex and run between the sides.  clipList() intersects it
// with the bin-tree - no object is needed for that - and yields the cells in the order near to far.  In a bin-tree that
// order depends on the apex alone: at every cut the side of the apex comes first.
//
// The list is conservative: a cell is left out only if its box lies outside of one side, or behind the apex.  It is a list
// of what to fetch; the walk of each ray decides what it visits, so a list that is too long or too short costs time,
// never a pixel.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <vector>

#include "rayshade/space/bintree.h"

namespace rayshade {

struct Pyramid {
  Vec3 apex;
  std::array<Vec3, 4> inward;  // normals of the sides, pointing inside; a zero one cuts nothing off
  Vec3 axis;                   // nothing of the pyramid is behind the plane through the apex across it
};

// The pyramid of four corner directions in order around it (world space, any length).  Corners that do not span a pyramid
// give one that is everywhere in front.
Pyramid pyramidOf(Vec3 apex, const std::array<Vec3, 4>& corners);

// The pyramid from an apex to the four corners of a parallelogram: a light pyramid.
Pyramid pyramidTo(Vec3 apex, Vec3 corner, Vec3 edgeU, Vec3 edgeV);

// The cells that the pyramid may touch, near to far.
std::vector<CellId> clipList(const BinTree& tree, const Pyramid& pyramid);

}  // namespace rayshade
