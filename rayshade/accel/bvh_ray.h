// How a single ray goes through the tree of a Bvh: four boxes are tested at once.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "rayshade/accel/bvh_tree.h"
#include "rayshade/accel/margins.h"

namespace rayshade::bvh_detail {

// A ray in the tree's coordinates, moved to where it enters the root box and rounded to float: outward on
// both sides.  s = t scale - start is its parameter, 0 at the root box.
struct BoxRay {
  Float4 nearOrigin[3], farOrigin[3], nearInverse[3], farInverse[3];
  Float4 limit;      // s of the end
  Float4 direction;  // x y z, roughly
  double scale, start;
  std::uint32_t octant;  // bit i: its direction is negative along axis i

  void setLimit(double tMax) {
    limit = splat(static_cast<float>((tMax * scale - start) * (1 + margins::kToFloat)));
  }
};

// The planes of four boxes where rays of one octant enter and leave.
struct Sides {
  Float4 nearX, nearY, nearZ, farX, farY, farZ;
  Sides(const BvhNode& node, std::uint32_t octant) {
    const std::uint32_t x = (octant & 1) != 0 ? 3 : 0, y = (octant & 2) != 0 ? 3 : 0,
                        z = (octant & 4) != 0 ? 3 : 0;
    nearX = node.plane[x];
    nearY = node.plane[1 + y];
    nearZ = node.plane[2 + z];
    farX = node.plane[3 - x];
    farY = node.plane[4 - y];
    farZ = node.plane[5 - z];
  }
};

// Which of four boxes the ray touches before its limit: all bits of a box or none; and where it enters them.
inline Int4 touchedBoxes(const Sides& sides, const BoxRay& ray, Float4& enters) {
  const Float4 nearX = (sides.nearX - ray.nearOrigin[0]) * ray.nearInverse[0];
  const Float4 nearY = (sides.nearY - ray.nearOrigin[1]) * ray.nearInverse[1];
  const Float4 nearZ = (sides.nearZ - ray.nearOrigin[2]) * ray.nearInverse[2];
  const Float4 farX = (sides.farX - ray.farOrigin[0]) * ray.farInverse[0];
  const Float4 farY = (sides.farY - ray.farOrigin[1]) * ray.farInverse[1];
  const Float4 farZ = (sides.farZ - ray.farOrigin[2]) * ray.farInverse[2];
  enters = maximum(maximum(nearX, nearY), maximum(nearZ, Float4{}));
  return enters <= minimum(minimum(farX, farY), minimum(farZ, ray.limit));
}

// Does the ray enter the root box within [tMin, tMax]?  kEverything: its numbers are too large or too small to tell.
enum class Entry { kMissed, kEntered, kEverything };
Entry enter(const BvhTree& tree, const Vec3& origin, const Vec3& direction, double tMin, double tMax,
            BoxRay& ray);

// From a child of the tree on, until a leaf answers true; near to far if kSorted.
template <bool kSorted, class Leaf>
bool traverseFrom(const BvhTree& tree, ChildRef top, BoxRay& ray, const double& tMax, Leaf&& leaf) {
  // An entry is near distance (bits of a non-negative float, which sort as integers) << 32 | child.
  std::uint64_t stack[kStackSize];
  int size = 0;
  ChildRef here = top;
  for (;;) {
    if (!isLeaf(here)) {
      const BvhNode& node = tree.nodes[here];
      const Sides sides(node, ray.octant);
      Float4 enters;
      const Int4 touched = touchedBoxes(sides, ray, enters) & Int4{1, 2, 4, 8};
      const auto halves =
          reinterpret_cast<Long2>(touched);  // stays in registers, unlike bit_cast to an array
      const auto either = static_cast<std::uint64_t>(halves[0] | halves[1]);
      std::uint32_t children = static_cast<std::uint32_t>(either | either >> 32);
      if (children != 0) {
        const auto distance = std::bit_cast<std::array<std::uint32_t, 4>>(enters);
        int child = std::countr_zero(children);
        children &= children - 1;
        if (children == 0) {
          here = node.child[child];
          continue;
        }
        const int base = size;
        for (;;) {
          const std::uint64_t entry = std::uint64_t{distance[child]} << 32 | node.child[child];
          int at = size++;
          if constexpr (kSorted)
            for (; at > base && stack[at - 1] < entry; --at) stack[at] = stack[at - 1];
          stack[at] = entry;
          if (children == 0) break;
          child = std::countr_zero(children);
          children &= children - 1;
        }
        here = static_cast<std::uint32_t>(stack[--size]);
        continue;
      }
    } else {
      const LeafItems items(here);
      if (leaf(items.first, items.count)) return true;
      ray.setLimit(tMax);
    }
    std::uint64_t entry;
    do {
      if (size == 0) return false;
      entry = stack[--size];
    } while (std::bit_cast<float>(static_cast<std::uint32_t>(entry >> 32)) > ray.limit[0]);
    here = static_cast<std::uint32_t>(entry);
  }
}

// The same from the root, with what is not in the tree.
template <bool kSorted, class Leaf>
bool traverse(const BvhTree& tree, const Vec3& origin, const Vec3& direction, double tMin, const double& tMax,
              Leaf&& leaf) {
  if (tree.unbounded > 0 && leaf(tree.inTree, tree.unbounded)) return true;
  if (tree.inTree == 0) return false;
  BoxRay ray;
  switch (enter(tree, origin, direction, tMin, tMax, ray)) {
    case Entry::kMissed:
      return false;
    case Entry::kEverything:
      return leaf(0u, tree.inTree);
    case Entry::kEntered:
      break;
  }
  return traverseFrom<kSorted>(tree, tree.root, ray, tMax, leaf);
}

}  // namespace rayshade::bvh_detail
