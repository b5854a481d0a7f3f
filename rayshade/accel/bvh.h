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

#include "rayshade/accel/simd.h"
#include "rayshade/base/bounds.h"
#include "rayshade/optics/ray.h"

namespace rayshade {

// A ray and the part of it that is of interest.
struct RayQuery {
  LocalRay ray;
  double tMin = 0, tMax = kInfinity;
};

// Rays of a bundle: bit i stands for the i-th.
using RaySet = std::uint32_t;
inline constexpr std::size_t kBundleSize = 32;

template <class Use>
void forEachRay(RaySet rays, Use&& use) {
  for (; rays != 0; rays &= rays - 1) use(static_cast<std::size_t>(std::countr_zero(rays)));
}

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

  // The same for up to kBundleSize rays (Query: a RayQuery) at once: a node is fetched once for all rays that come to it.
  // Calls leaf(first, count, rays), which answers with the rays whose tMax it has lowered.  Include bvh_bundle.h.
  template <class Query, class Leaf>
  [[gnu::always_inline]] inline void nearest(std::span<Query> bundle, Leaf&& leaf) const {
    traverseTogether<true>(bundle, leaf);
  }
  // Here leaf(first, count, rays) answers with the rays that have found what they look for.
  template <class Query, class Leaf>
  [[gnu::always_inline]] inline void any(std::span<Query> bundle, Leaf&& leaf) const {
    traverseTogether<false>(bundle, leaf);
  }

 private:
  // Where the tree's arithmetic cannot overflow: larger items count as unbounded, longer or shorter directions
  // and farther origins see every item.
  static constexpr double kLargest = 0x1p+500;
  static constexpr double kSmallest = 0x1p-500;
  static constexpr double kFarthest =
      0x1p+100;  // in the tree's coordinates: 2^100 times the size of the scene

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
    Float4 limit;      // s of the end
    Float4 direction;  // x y z, roughly
    double scale, start;
    std::uint32_t octant;  // bit i: its direction is negative along axis i

    void setLimit(double tMax) { limit = splat(static_cast<float>((tMax * scale - start) * (1 + 0x1p-22))); }
  };

  // The planes of four boxes where rays of one octant enter and leave.
  struct Sides {
    Float4 nearX, nearY, nearZ, farX, farY, farZ;
    Sides(const Node& node, std::uint32_t octant) {
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

  // Which of four boxes the ray touches before its limit: all bits of a lane or none; and where it enters them.
  static Int4 touchedBoxes(const Sides& sides, const BoxRay& ray, Float4& enters) {
    const Float4 nearX = (sides.nearX - ray.nearOrigin[0]) * ray.nearInverse[0];
    const Float4 nearY = (sides.nearY - ray.nearOrigin[1]) * ray.nearInverse[1];
    const Float4 nearZ = (sides.nearZ - ray.nearOrigin[2]) * ray.nearInverse[2];
    const Float4 farX = (sides.farX - ray.farOrigin[0]) * ray.farInverse[0];
    const Float4 farY = (sides.farY - ray.farOrigin[1]) * ray.farInverse[1];
    const Float4 farZ = (sides.farZ - ray.farOrigin[2]) * ray.farInverse[2];
    enters = maximum(maximum(nearX, nearY), maximum(nearZ, Float4{}));
    return enters <= minimum(minimum(farX, farY), minimum(farZ, ray.limit));
  }

  struct LeafItems {
    std::uint32_t first, count;
    explicit LeafItems(std::uint32_t child)
        : first(child & ((1u << kFirstBits) - 1)), count(((child & ~kLeaf) >> kFirstBits) + 1) {}
  };

  // The same of all rays of a bundle, side by side: ray i is lane i % 8 of group i / 8.
  struct BoxRays {
    static constexpr std::size_t kLanes = 8, kGroups = kBundleSize / kLanes;
    Float8 nearOrigin[3][kGroups], farOrigin[3][kGroups], nearInverse[3][kGroups], farInverse[3][kGroups];
    Float8 limit[kGroups];
    float direction[3][kBundleSize];
    double scale[kBundleSize], start[kBundleSize];
    RaySet negative[3];  // direction along an axis

    void setLimit(std::size_t i, double tMax) {
      limit[i / kLanes][i % kLanes] = static_cast<float>((tMax * scale[i] - start[i]) * (1 + 0x1p-22));
    }
    BoxRay one(std::size_t i, std::uint32_t octant) const {
      const std::size_t group = i / kLanes, lane = i % kLanes;
      BoxRay ray;
      for (int axis = 0; axis < 3; ++axis) {
        ray.nearOrigin[axis] = splat(nearOrigin[axis][group][lane]);
        ray.farOrigin[axis] = splat(farOrigin[axis][group][lane]);
        ray.nearInverse[axis] = splat(nearInverse[axis][group][lane]);
        ray.farInverse[axis] = splat(farInverse[axis][group][lane]);
      }
      ray.limit = splat(limit[group][lane]);
      ray.direction = Float4{direction[0][i], direction[1][i], direction[2][i], 0};
      ray.scale = scale[i];
      ray.start = start[i];
      ray.octant = octant;
      return ray;
    }
  };

  enum class Entry { kMissed, kEntered, kEverything };
  Entry enter(const Vec3& origin, const Vec3& direction, double tMin, double tMax, BoxRay& ray) const;

  struct Piece;
  struct Range;
  class Builder;

  template <bool kSorted, class Leaf>
  bool traverse(const Vec3& origin, const Vec3& direction, double tMin, const double& tMax,
                Leaf&& leaf) const;
  template <bool kSorted, class Leaf>
  bool traverseFrom(std::uint32_t top, BoxRay& ray, const double& tMax, Leaf&& leaf) const;
  template <bool kSorted, class Query, class Leaf>
  [[gnu::always_inline]] inline void traverseTogether(std::span<Query> bundle, Leaf&& leaf) const;
  // Rays that enter, and those that must be tested against everything.
  struct Entered {
    RaySet inside, everything;
  };
  template <class Query>
  [[gnu::always_inline]] inline Entered enterTogether(std::span<const Query> bundle, BoxRays& rays) const;

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
  return traverseFrom<kSorted>(root_, ray, tMax, leaf);
}

template <bool kSorted, class Leaf>
bool Bvh::traverseFrom(std::uint32_t top, BoxRay& ray, const double& tMax, Leaf&& leaf) const {
  // An entry is near distance (bits of a non-negative float, which sort as integers) << 32 | child.
  std::uint64_t stack[kStackSize];
  int size = 0;
  std::uint32_t here = top;
  for (;;) {
    if ((here & kLeaf) == 0) {
      const Node& node = nodes_[here];
      const Sides sides(node, ray.octant);
      Float4 enters;
      const Int4 touched = touchedBoxes(sides, ray, enters) & Int4{1, 2, 4, 8};
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

}  // namespace rayshade
