// Bvh: which of many boxes does a ray touch, near to far.
//
// A tree of four children per node, in coordinates of its own (bvh_tree.h).  The test of a box never misses one that the
// exact ray touches within [tMin, tMax] (proof in margins.h), it may visit one too many; so the tree decides how long an
// answer takes, never what it is.
//
// order() lists the items leaf by leaf: lay out what belongs to them in that order.  A leaf is called with
// (first, count): positions in order().  Items whose bounds are not finite are offered to every ray, items
// with empty bounds to none.
//
// Sources: Wald, Benthin & Boulos 2008, Getting Rid of Packets (four children); Ize 2013, Robust BVH Ray
// Traversal (why a slab test must be widened).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <utility>

#include "rayshade/accel/bvh_build.h"
#include "rayshade/accel/bvh_ray.h"
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

namespace bvh_detail {

// In bvh_bundle.h.
template <bool kSorted, class Query, class Leaf>
[[gnu::always_inline]] inline void traverseTogether(const BvhTree& tree, std::span<Query> bundle,
                                                    Leaf&& leaf);

}  // namespace bvh_detail

class Bvh {
 public:
  Bvh() = default;
  // `items` in any space, at most kMostItems; the caller has padded them.
  explicit Bvh(std::span<const Bounds> items) : tree_(buildBvh(items)) {}
  Bvh(std::size_t items, const BoundsOf& boundsOf, unsigned threads = 1)
      : tree_(buildBvh(items, boundsOf, threads)) {}

  std::span<const std::uint32_t> order() const { return tree_.order; }
  // So many of the order, from its beginning, may be met.
  std::size_t held() const { return tree_.inTree + tree_.unbounded; }
  // The order for him who lays out his items; it is not kept.
  std::vector<std::uint32_t> takeOrder() { return std::exchange(tree_.order, {}); }
  std::size_t bytes() const {
    return sizeof *this + tree_.nodes.capacity() * sizeof(BvhNode) +
           tree_.order.capacity() * sizeof(std::uint32_t);
  }

  // Calls leaf(first, count) for the leaves that the ray touches within [tMin, tMax], roughly near to far.
  // The leaf may lower tMax; items that begin at exactly tMax are still visited, so that it can settle ties.
  // A ray with NaN or infinity in it touches nothing.  |direction| need not be 1.
  template <class Leaf>
  void nearest(const Vec3& origin, const Vec3& direction, double tMin, double& tMax, Leaf&& leaf) const {
    bvh_detail::traverse<true>(tree_, origin, direction, tMin, tMax,
                               [&](std::uint32_t first, std::uint32_t count) {
                                 leaf(first, count);
                                 return false;
                               });
  }

  // The same until a leaf answers true, in any order.
  template <class Leaf>
  bool any(const Vec3& origin, const Vec3& direction, double tMin, double tMax, Leaf&& leaf) const {
    return bvh_detail::traverse<false>(tree_, origin, direction, tMin, tMax, leaf);
  }

  // The same for up to kBundleSize rays (Query: a RayQuery) at once: a node is fetched once for all rays that come to it.
  // Calls leaf(first, count, rays), which answers with the rays whose tMax it has lowered.  Include bvh_bundle.h.
  template <class Query, class Leaf>
  [[gnu::always_inline]] inline void nearest(std::span<Query> bundle, Leaf&& leaf) const {
    bvh_detail::traverseTogether<true>(tree_, bundle, leaf);
  }
  // Here leaf(first, count, rays) answers with the rays that have found what they look for.
  template <class Query, class Leaf>
  [[gnu::always_inline]] inline void any(std::span<Query> bundle, Leaf&& leaf) const {
    bvh_detail::traverseTogether<false>(tree_, bundle, leaf);
  }

 private:
  BvhTree tree_;
};

}  // namespace rayshade
