// Where a box is cut so that memory, then work, then what crosses the cut are shared out best.
//
// An object that touches a plane is held on both sides of it, so the bytes of both sides are counted as they will be held.
// First of all no side may have more than its portion, of the bytes and of the objects, as far as `slack` allows; where no plane can do that, the one is taken
// that does it best and is crossed by little.  Of the planes that can, the best has the least sum of three parts, each
// relative to the whole: the work of the busier side beyond its portion, the work at the plane itself (rays cross it
// there), and what is held twice.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "rayshade/space/bintree.h"

namespace rayshade {

// The low side gets the first `below` voxels, between a third and two thirds of them: as many as fit what is there, so that
// things of some size need not be cut.
struct Cut {
  int axis = 0;
  double split = 0;
  std::uint32_t below = 1;
};

// `portions`: what the voxels of the box, two at least, are to have.  `slack`: a side may have so many times its portion of the
// bytes, at least 1.  Nothing if there is nothing to be shared out, or no plane inside of the box.
// `inside`: which of the objects touch the box.
std::optional<Cut> balancedCut(const Bounds& box, std::span<const HeldBox> objects,
                               std::span<const std::uint32_t> inside, std::span<const CostBox> costs,
                               std::span<const Portion> portions, double slack);

// The part of a box below the plane, by length.
double shareBelow(const Bounds& box, int axis, double split);

}  // namespace rayshade
