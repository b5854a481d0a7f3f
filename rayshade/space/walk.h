// The walk of a ray: the voxels (or cells) that it crosses, in order, as a pure function of tree and ray.
//
//   ts(plane) = (split - origin) / direction                   one expression, evaluated by every task
//   first child = the side the origin is on; on the plane itself, the side the ray goes to, and the high side
//                 when it goes to neither (cells are [low, high))
//   a plane is crossed iff the ray goes towards it: never when direction == 0 or the origin is on it
//   step k owns [tEnter_k, tExit_k);  tEnter_0 == 0,  tExit_k == tEnter_{k+1} bitwise,  the last is infinite
//   a hit is accepted in step k iff tMin < t < tExit_k         (no lower bound but tMin)
//
// Partition of [0, infinity): the root owns all of it, and a crossed plane cuts the interval of its node at
// ts; an interval that would be empty (ts <= tEnter, ts >= tExit) is no step at all, so that one node hands on
// the whole to the other child.  Rounding may move a border by an ulp, but moves it for both sides.
// Planes of one axis keep their order because rounding is monotone.  So each t belongs to exactly one step,
// and what is nearest among the objects that touch a voxel is nearest there: nothing is lost or counted twice
// as long as bounds are padded by more than the rounding of t (base/bounds.h) before voxelsTouching().
//
// Rays of any length work; one with NaN walks through some cell and ends.
// Source: Sung & Shirley 1992 (walk of a BSP tree); the half-open rule is our own.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "rayshade/space/bintree.h"

namespace rayshade {

template <class Id>
struct WalkStep {
  Id where{};
  double tEnter = 0, tExit = kInfinity;
  friend bool operator==(const WalkStep&, const WalkStep&) = default;
};

// An iterator of fixed size; the tree must outlive it.
template <class Id>
class Walk {
 public:
  Walk(const BinTree& tree, const Vec3& origin, const Vec3& direction)
      : tree_(tree), origin_(origin), direction_(direction) {
    stack_[0] = {0, kInfinity};
  }

  // The next step, or false after the last one.
  bool next(WalkStep<Id>& step);

 private:
  struct Open {
    std::uint32_t node;
    double tExit;
  };

  const BinTree& tree_;
  Vec3 origin_, direction_;
  double tEnter_ = 0;
  int size_ = 1;
  Open stack_[kMaxTreeDepth + 1];
};

using VoxelWalk = Walk<VoxelId>;
using CellWalk = Walk<CellId>;

// Step number `index`, counted from 0: the position that travels in messages.  Nothing when the walk is
// shorter than that.
template <class Id>
std::optional<WalkStep<Id>> stepAt(const BinTree& tree, const Vec3& origin, const Vec3& direction,
                                   std::uint32_t index) {
  Walk<Id> walk(tree, origin, direction);
  WalkStep<Id> step;
  for (std::uint32_t i = 0; walk.next(step); ++i)
    if (i == index) return step;
  return std::nullopt;
}

}  // namespace rayshade
