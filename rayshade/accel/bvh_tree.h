// The tree of a Bvh: plain data.
//
// Four children per node, their boxes side by side.  The boxes lie as floats, rounded outward, in coordinates of the tree's
// own: x' = (x - centre) scale, scale a power of two, so that everything is within about [-1, 1] wherever and however
// large the scene is.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <vector>

#include "rayshade/accel/simd.h"
#include "rayshade/base/bounds.h"

namespace rayshade {

// A reference to a child: the number of a node, or a leaf: kLeaf | (count - 1) << kFirstBits | first.
using ChildRef = std::uint32_t;
inline constexpr ChildRef kLeaf = 0x80000000u;
inline constexpr int kFirstBits = 28;
constexpr ChildRef leafOf(std::uint32_t first, std::uint32_t count) {
  return kLeaf | (count - 1) << kFirstBits | first;
}
constexpr bool isLeaf(ChildRef child) { return (child & kLeaf) != 0; }
struct LeafItems {
  std::uint32_t first, count;  // positions in the order of the tree
  explicit LeafItems(ChildRef leaf)
      : first(leaf & ((1u << kFirstBits) - 1)), count(((leaf & ~kLeaf) >> kFirstBits) + 1) {}
};

struct alignas(64) BvhNode {
  Float4 plane[6];  // low x y z, high x y z of the four children
  ChildRef child[4];
};

// No leaf is deeper than this below the root, whatever the items are (bvh_build.cc, split()).  A node pushes at
// most four children and pops one of them, so that many entries are enough for a stack.
inline constexpr int kMaxDepth = 48;
inline constexpr int kStackSize = 3 * kMaxDepth + 1;

struct BvhTree {
  std::vector<BvhNode> nodes;
  std::vector<std::uint32_t> order;  // items of leaves, unbounded items, empty items
  std::uint32_t inTree = 0, unbounded = 0;
  ChildRef root = 0;
  Vec3 centre;
  double scale = 1;
  Bounds box;  // of all items in the tree, in its coordinates
};

// 2^exponent, for exponents of normal numbers.
inline double powerOfTwo(int exponent) { return std::bit_cast<double>(std::uint64_t(1023 + exponent) << 52); }

// The exponent of a normal number x: 2^exponent <= x < 2^(exponent + 1).
inline int exponentOf(double x) {
  return static_cast<int>(std::bit_cast<std::uint64_t>(x) >> 52 & 0x7ff) - 1023;
}

}  // namespace rayshade
