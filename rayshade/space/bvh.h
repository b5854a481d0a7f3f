// Bvh: which of many boxes does a ray touch, near to far.
//
// A tree of four children per node.  The boxes lie as floats, rounded outward, in coordinates of the tree's
// own: x' = (x - centre) scale, scale a power of two, so that everything is within about [-1, 1] wherever
// and however large the scene is.  The four boxes of a node are tested at once.  The test never misses a box
// that the exact ray touches within [tMin, tMax] (proof at enter() in bvh.cc), it may visit one too many; so
// the tree decides how long an answer takes, never what it is.
//
// order() lists the items leaf by leaf: lay out what belongs to them in that order.  A leaf is called with
// (first, count): positions in order().  Items whose bounds are not finite are offered to every ray, items
// with empty bounds to none.
//
// Sources: Wald, Benthin & Boulos 2008, Getting Rid of Packets (four children); Ize 2013, Robust BVH Ray
// Traversal (why a slab test must be widened); Wald 2007, On Fast Construction of SAH-based BVHs (bins).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "rayshade/base/bounds.h"

namespace rayshade {

// Vector extensions of GCC and clang: element by element, the same bits on every machine.
typedef float Float4 __attribute__((vector_size(16)));
typedef std::int32_t Int4 __attribute__((vector_size(16)));
typedef std::int64_t Long2 __attribute__((vector_size(16)));

inline Float4 minimum(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 maximum(Float4 a, Float4 b) { return a > b ? a : b; }
inline Float4 all(float x) { return Float4{x, x, x, x}; }

class Bvh {
 public:
  Bvh() = default;
  // `items` in any space, at most kMaxItems; the caller has padded them.
  explicit Bvh(std::span<const Bounds> items);

  static constexpr std::size_t kMaxItems = std::size_t{1} << 28;

  std::span<const std::uint32_t> order() const { return order_; }
  std::size_t bytes() const;

  // Calls leaf(first, count) for the leaves that the ray touches within [tMin, tMax], roughly near to far.
  // The leaf may lower tMax; items that begin at exactly tMax are still visited, so that it can settle ties.
  // A ray with NaN or infinity in it touches nothing.  |direction| need not be 1.
  template <class Leaf>
  void nearest(const Vec3& origin, const Vec3& direction, double tMin, double& tMax, Leaf&& leaf) const {
    traverse<true>(origin, direction, tMin, tMax, [&](std::uint32_t first, std::uint32_t count) {
      leaf(first, count);
      return false;
    });
  }

  // The same until a leaf answers true, in any order.
  template <class Leaf>
  bool any(const Vec3& origin, const Vec3& direction, double tMin, double tMax, Leaf&& leaf) const {
    return traverse<false>(origin, direction, tMin, tMax, leaf);
  }

 private:
  // A reference to a child: the number of a node, or a leaf: kLeaf | (count - 1) << kFirstBits | first.
  static constexpr std::uint32_t kLeaf = 0x80000000u;
  static constexpr int kFirstBits = 28;
  // No leaf is deeper than this below the root, whatever the items are (bvh.cc, split()).  A node pushes at
  // most four children and pops one of them, so this many entries are enough.
  static constexpr int kMaxDepth = 48;
  static constexpr int kStackSize = 3 * kMaxDepth + 1;

  struct alignas(64) Node {
    Float4 plane[6];  // low x y z, high x y z of the four children
    std::uint32_t child[4];
  };

  // A ray in the tree's coordinates, moved to where it enters the root box and rounded to float: outward on
  // both sides.  s = t scale - start is its parameter, 0 at the root box.
  struct BoxRay {
    Float4 nearOrigin[3], farOrigin[3], nearInverse[3], farInverse[3];
    int nearPlane[3], farPlane[3];
    double scale, start;

    float limit(double tMax) const { return static_cast<float>((tMax * scale - start) * (1 + 0x1p-22)); }
  };

  enum class Entry { kMissed, kEntered, kEverything };
  Entry enter(const Vec3& origin, const Vec3& direction, double tMin, double tMax, BoxRay& ray) const;

  struct Piece;
  struct Range;
  class Builder;

  template <bool kSorted, class Leaf>
  bool traverse(const Vec3& origin, const Vec3& direction, double tMin, const double& tMax,
                Leaf&& leaf) const;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;  // items of leaves, unbounded items, empty items
  std::uint32_t inTree_ = 0, unbounded_ = 0, root_ = 0;
  Vec3 centre_;
  double scale_ = 1;
  Bounds box_;  // of all items in the tree, in its coordinates
};

template <bool kSorted, class Leaf>
bool Bvh::traverse(const Vec3& origin, const Vec3& direction, double tMin, const double& tMax,
                   Leaf&& leaf) const {
  if (unbounded_ > 0 && leaf(inTree_, unbounded_)) return true;
  if (inTree_ == 0) return false;
  BoxRay ray;
  switch (enter(origin, direction, tMin, tMax, ray)) {
    case Entry::kMissed:
      return false;
    case Entry::kEverything:
      return leaf(0u, inTree_);
    case Entry::kEntered:
      break;
  }

  // An entry is near distance (bits of a non-negative float, which sort as integers) << 32 | child.
  std::uint64_t stack[kStackSize];
  int size = 0;
  std::uint32_t here = root_;
  float limit = ray.limit(tMax);
  for (;;) {
    if ((here & kLeaf) == 0) {
      const Node& node = nodes_[here];
      const Float4 zero{};
      const auto near = [&](int axis) {
        return (node.plane[ray.nearPlane[axis]] - ray.nearOrigin[axis]) * ray.nearInverse[axis];
      };
      const auto far = [&](int axis) {
        return (node.plane[ray.farPlane[axis]] - ray.farOrigin[axis]) * ray.farInverse[axis];
      };
      const Float4 enters = maximum(maximum(near(0), near(1)), maximum(near(2), zero));
      const Float4 leaves = minimum(minimum(far(0), far(1)), minimum(far(2), all(limit)));
      const Int4 touched = (enters <= leaves) & Int4{1, 2, 4, 8};
      const auto halves =
          reinterpret_cast<Long2>(touched);  // stays in registers, unlike bit_cast to an array
      const auto either = static_cast<std::uint64_t>(halves[0] | halves[1]);
      std::uint32_t lanes = static_cast<std::uint32_t>(either | either >> 32);
      if (lanes != 0) {
        const auto distance = std::bit_cast<std::array<std::uint32_t, 4>>(enters);
        int lane = std::countr_zero(lanes);
        lanes &= lanes - 1;
        if (lanes == 0) {
          here = node.child[lane];
          continue;
        }
        const int base = size;
        for (;;) {
          const std::uint64_t entry = std::uint64_t{distance[lane]} << 32 | node.child[lane];
          int at = size++;
          if constexpr (kSorted)
            for (; at > base && stack[at - 1] < entry; --at) stack[at] = stack[at - 1];
          stack[at] = entry;
          if (lanes == 0) break;
          lane = std::countr_zero(lanes);
          lanes &= lanes - 1;
        }
        here = static_cast<std::uint32_t>(stack[--size]);
        continue;
      }
    } else {
      const std::uint32_t first = here & ((1u << kFirstBits) - 1);
      const std::uint32_t count = ((here & ~kLeaf) >> kFirstBits) + 1;
      if (leaf(first, count)) return true;
      limit = ray.limit(tMax);
    }
    std::uint64_t entry;
    do {
      if (size == 0) return false;
      entry = stack[--size];
    } while (std::bit_cast<float>(static_cast<std::uint32_t>(entry >> 32)) > limit);
    here = static_cast<std::uint32_t>(entry);
  }
}

}  // namespace rayshade
