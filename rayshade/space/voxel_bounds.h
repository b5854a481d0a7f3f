// VoxelBounds: where in space there is anything, without saying what.
//
// A task knows of each cell the box around the objects in it, of its own cells and of all others.  A ray that meets none
// of the boxes of a voxel need not go there: what is nearest is elsewhere.  The test may say yes too often, never
// too rarely, so it decides what is sent and not what is seen.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/accel/bvh.h"
#include "rayshade/space/bintree.h"

namespace rayshade {

// The part of an object's padded bounds that lies in a cell, padded again; world space.
Bounds boundsInCell(const Bounds& object, const BinTree& tree, CellId cell);

class VoxelBounds {
 public:
  VoxelBounds() = default;
  // `cells`: by cell, the box around what is in it; empty: nothing.
  VoxelBounds(const BinTree& tree, std::span<const Bounds> cells);

  // Could the ray meet something in this voxel at t in [tMin, tMax]?
  bool mayMeet(VoxelId voxel, const Vec3& origin, const Vec3& direction, double tMin, double tMax) const {
    return voxels_[static_cast<std::size_t>(voxel)].any(origin, direction, tMin, tMax,
                                                        [](std::uint32_t, std::uint32_t) { return true; });
  }

 private:
  std::vector<Bvh> voxels_;
};

}  // namespace rayshade
