// How a bundle of rays goes through a Bvh: each box is tested for eight rays at a time.
//
// Rays of one octant go together, near to far along the first of them; as soon as no more than a few of them are left in
// a node each goes on alone.  The tests are those of single rays (bvh_ray.h), so no box is missed.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/accel/bvh.h"

namespace rayshade {
namespace bvh_detail {

// The rays of a bundle as BoxRays, side by side: ray i is number i % kGroup of group i / kGroup.
struct BoxRays {
  static constexpr std::size_t kGroup = 8, kGroups = kBundleSize / kGroup;
  Float8 nearOrigin[3][kGroups], farOrigin[3][kGroups], nearInverse[3][kGroups], farInverse[3][kGroups];
  Float8 limit[kGroups];
  Float8 direction[3][kGroups];
  Double8 scale[kGroups], start[kGroups];
  RaySet negative[3];  // direction along an axis

  void setLimit(std::size_t i, double tMax) {
    limit[i / kGroup][i % kGroup] = static_cast<float>(
        (tMax * scale[i / kGroup][i % kGroup] - start[i / kGroup][i % kGroup]) * (1 + margins::kToFloat));
  }
  BoxRay one(std::size_t i, std::uint32_t octant) const {
    const std::size_t group = i / kGroup, at = i % kGroup;
    BoxRay ray;
    for (int axis = 0; axis < 3; ++axis) {
      ray.nearOrigin[axis] = splat(nearOrigin[axis][group][at]);
      ray.farOrigin[axis] = splat(farOrigin[axis][group][at]);
      ray.nearInverse[axis] = splat(nearInverse[axis][group][at]);
      ray.farInverse[axis] = splat(farInverse[axis][group][at]);
    }
    ray.limit = splat(limit[group][at]);
    ray.direction = Float4{direction[0][group][at], direction[1][group][at], direction[2][group][at], 0};
    ray.scale = scale[group][at];
    ray.start = start[group][at];
    ray.octant = octant;
    return ray;
  }
};

// All bits that any of the eight has.
[[gnu::always_inline]] inline std::uint32_t anyBits(const Int8& eight) {
  const auto wide = reinterpret_cast<const Long4&>(eight);
  const auto either = static_cast<std::uint64_t>(wide[0] | wide[1] | wide[2] | wide[3]);
  return static_cast<std::uint32_t>(either | either >> 32);
}

// A number of each of eight queries.
template <class Query, class Number>
[[gnu::always_inline]] inline Double8 ofEach(const Query* const (&of)[8], Number&& number) {
  return Double8{number(*of[0]), number(*of[1]), number(*of[2]), number(*of[3]),
                 number(*of[4]), number(*of[5]), number(*of[6]), number(*of[7])};
}

// The rays of a group for which a comparison holds.
[[gnu::always_inline]] inline RaySet raysWhere(const Long8& holds, std::size_t group) {
  const Int8 bits = Int8{1, 2, 4, 8, 16, 32, 64, 128} << static_cast<std::int32_t>(8 * group);
  return anyBits(__builtin_convertvector(holds, Int8) & bits);
}

// Rays that enter, and those that must be tested against everything.
struct Entered {
  RaySet inside, everything;
};

// enter() of bvh_ray.cc for eight rays at a time, with the same margins.
template <class Query>
[[gnu::always_inline]] inline Entered enterTogether(const BvhTree& tree, std::span<const Query> bundle,
                                                    BoxRays& rays) {
  constexpr std::size_t kGroup = BoxRays::kGroup;
  Entered entered{0, 0};
  rays.negative[0] = rays.negative[1] = rays.negative[2] = 0;
  for (std::size_t group = 0; group * kGroup < bundle.size(); ++group) {
    const std::size_t first = group * kGroup, count = std::min(kGroup, bundle.size() - first);
    const Query* of[kGroup];
    for (std::size_t i = 0; i < kGroup; ++i) of[i] = &bundle[first + std::min(i, count - 1)];
    const Double8 origin[3] = {ofEach(of, [](const Query& q) RAYSHADE_INLINE { return q.ray.origin.x; }),
                               ofEach(of, [](const Query& q) RAYSHADE_INLINE { return q.ray.origin.y; }),
                               ofEach(of, [](const Query& q) RAYSHADE_INLINE { return q.ray.origin.z; })};
    const Double8 direction[3] = {
        ofEach(of, [](const Query& q) RAYSHADE_INLINE { return q.ray.direction.x; }),
        ofEach(of, [](const Query& q) RAYSHADE_INLINE { return q.ray.direction.y; }),
        ofEach(of, [](const Query& q) RAYSHADE_INLINE { return q.ray.direction.z; })};
    const Double8 tMin = ofEach(of, [](const Query&q) RAYSHADE_INLINE { return q.tMin; }),
                  tMax = ofEach(of, [](const Query&q) RAYSHADE_INLINE { return q.tMax; });
    const auto magnitude = [](const Double8& x) __attribute__((always_inline)) { return x < 0 ? -x : x; };
    const Double8 lengths[3] = {magnitude(direction[0]), magnitude(direction[1]), magnitude(direction[2])};
    Double8 reach = lengths[0] > lengths[1] ? lengths[0] : lengths[1];
    reach = reach > lengths[2] ? reach : lengths[2];
    // A power of two, and the inverse of it: 0x7fe... - exponent is that of the inverse.
    const Long8 exponent = reinterpret_cast<Long8>(reach) & 0x7ff0000000000000;
    const auto stretch = reinterpret_cast<Double8>(exponent);
    const auto perStretch = reinterpret_cast<Double8>(0x7fe0000000000000 - exponent);
    const Double8 scale = stretch * tree.scale;

    Double8 start = tMin * scale, end = tMax * scale;
    Double8 place[3], d[3], exactly[3], away[3];
    // NaN and infinity fail the comparison, too.
    Long8 ordinary = (reach >= margins::kSmallest) & (reach <= margins::kLargest);
    for (int axis = 0; axis < 3; ++axis) {
      place[axis] = (origin[axis] - tree.centre[axis]) * tree.scale;
      away[axis] = magnitude(place[axis]);
      ordinary &= (away[axis] <= margins::kFarthest) & (lengths[axis] <= margins::kLargest);
      d[axis] = direction[axis] * perStretch;
      exactly[axis] = 1.0 / d[axis];
      const Double8 slack = margins::kSlack * (1.0 + away[axis]);
      const Double8 toLow = (tree.box.low[axis] - slack - place[axis]) * exactly[axis];
      const Double8 toHigh = (tree.box.high[axis] + slack - place[axis]) * exactly[axis];
      const Double8 near = exactly[axis] > 0 ? toLow : toHigh, far = exactly[axis] > 0 ? toHigh : toLow;
      start = near > start ? near : start;
      end = far < end ? far : end;
    }
    const Long8 inside = ordinary & (start <= end);
    const RaySet present = static_cast<RaySet>(((std::uint64_t{1} << count) - 1) << first);
    forEachRay(~raysWhere(ordinary, group) & present, [&](std::size_t i) {
      const Query& query = bundle[i];
      BoxRay alone;
      const Entry entry = enter(tree, query.ray.origin, query.ray.direction, query.tMin, query.tMax, alone);
      // A ray that stands still is no ordinary one; to look at all is right for any.
      if (entry != Entry::kMissed) entered.everything |= RaySet{1} << i;
    });
    const RaySet entering = raysWhere(inside, group) & present;
    if (entering == 0) continue;  // most bundles that miss everything
    entered.inside |= entering;
    start = start < -margins::kLargest  ? Double8{} - margins::kLargest
            : start > margins::kLargest ? Double8{} + margins::kLargest
                                        : start;
    rays.limit[group] = __builtin_convertvector((tMax * scale - start) * (1 + margins::kToFloat), Float8);
    for (int axis = 0; axis < 3; ++axis) {
      const Double8 step = start * d[axis], p = place[axis] + step;
      const Double8 margin =
          margins::kToFloat * magnitude(p) + 2 * margins::kSlack * (1.0 + away[axis] + magnitude(step));
      const Float8 at = __builtin_convertvector(p, Float8), moved = __builtin_convertvector(margin, Float8);
      // Off the planes of the box: at least the flattest, with its sign, which -0 has, too.
      const Long8 sign = reinterpret_cast<Long8>(d[axis]) >> 63;
      const Double8 least =
          sign != 0 ? Double8{} - margins::kSteepestInverse : Double8{} + margins::kSteepestInverse;
      const Double8 inverse = magnitude(d[axis]) > margins::kFlattest ? exactly[axis] : least;
      const Float8 narrow = __builtin_convertvector(inverse, Float8);
      const Float8 forward = narrow > 0 ? moved : -moved;
      rays.nearOrigin[axis][group] = at + forward;
      rays.farOrigin[axis][group] = at - forward;
      rays.nearInverse[axis][group] = narrow * (1 - margins::kSlab);
      rays.farInverse[axis][group] = narrow * (1 + margins::kSlab);
      rays.direction[axis][group] = __builtin_convertvector(d[axis], Float8);
      rays.negative[axis] |= raysWhere(sign, group);
    }
    rays.scale[group] = scale;
    rays.start[group] = start;
  }
  return entered;
}

template <bool kSorted, class Query, class Leaf>
[[gnu::always_inline]] inline void traverseTogether(const BvhTree& tree, std::span<Query> bundle,
                                                    Leaf&& leaf) {
  RaySet waiting = static_cast<RaySet>((std::uint64_t{1} << bundle.size()) - 1);
  const auto visitLeaf = [&](std::uint32_t first, std::uint32_t count, RaySet asking) {
    const RaySet answer = leaf(first, count, asking);
    if constexpr (!kSorted) waiting &= ~answer;
    return answer;
  };
  if (tree.unbounded > 0) visitLeaf(tree.inTree, tree.unbounded, waiting);
  if (tree.inTree == 0) return;
  BoxRays rays;
  const Entered entered = enterTogether(tree, std::span<const Query>(bundle), rays);
  if ((entered.everything & waiting) != 0) visitLeaf(0u, tree.inTree, entered.everything & waiting);

  struct Open {
    float depth;  // of the near corner along one of the rays
    ChildRef child;
    RaySet rays;
  };
  Open stack[kStackSize];
  for (std::uint32_t octant = 0; octant < 8; ++octant) {
    RaySet going = entered.inside;
    for (int axis = 0; axis < 3; ++axis)
      going &= (octant >> axis & 1) != 0 ? rays.negative[axis] : ~rays.negative[axis];
    if (going == 0) continue;
    int size = 0;
    stack[size++] = {0, tree.root, going};
    while (size > 0) {
      Open here = stack[--size];
      here.rays &= waiting;
      if (here.rays == 0) continue;
      if (isLeaf(here.child)) {
        const LeafItems items(here.child);
        const RaySet answer = visitLeaf(items.first, items.count, here.rays);
        if constexpr (kSorted) forEachRay(answer, [&](std::size_t i) { rays.setLimit(i, bundle[i].tMax); });
        continue;
      }
      const RaySet others = here.rays & (here.rays - 1);
      if ((others & (others - 1)) == 0) {  // one or two
        forEachRay(here.rays, [&](std::size_t i) {
          const RaySet only = RaySet{1} << i;
          BoxRay ray = rays.one(i, octant);
          traverseFrom<kSorted>(tree, here.child, ray, bundle[i].tMax,
                                [&](std::uint32_t first, std::uint32_t count) {
                                  return visitLeaf(first, count, only) != 0 && !kSorted;
                                });
          if constexpr (kSorted) rays.setLimit(i, bundle[i].tMax);
        });
        continue;
      }
      const BvhNode& node = tree.nodes[here.child];
      const std::size_t x = octant & 1, y = octant >> 1 & 1, z = octant >> 2 & 1;
      const Float4 &nearX = node.plane[3 * x], &nearY = node.plane[1 + 3 * y], &nearZ = node.plane[2 + 3 * z];
      const Float4 &farX = node.plane[3 - 3 * x], &farY = node.plane[4 - 3 * y],
                   &farZ = node.plane[5 - 3 * z];
      Int8 touching[4] = {};  // of each child: the rays, those of one place in all groups together
      for (std::size_t group = 0; group < BoxRays::kGroups; ++group) {
        if ((here.rays >> (8 * group) & 0xff) == 0) continue;
        const Int8 bits = Int8{1, 2, 4, 8, 16, 32, 64, 128} << static_cast<std::int32_t>(8 * group);
        const Float8 fromX = rays.nearOrigin[0][group], perX = rays.nearInverse[0][group];
        const Float8 fromY = rays.nearOrigin[1][group], perY = rays.nearInverse[1][group];
        const Float8 fromZ = rays.nearOrigin[2][group], perZ = rays.nearInverse[2][group];
        const Float8 toX = rays.farOrigin[0][group], farPerX = rays.farInverse[0][group];
        const Float8 toY = rays.farOrigin[1][group], farPerY = rays.farInverse[1][group];
        const Float8 toZ = rays.farOrigin[2][group], farPerZ = rays.farInverse[2][group];
        const Float8 limit = rays.limit[group];
        for (int child = 0; child < 4; ++child) {
          const Float8 enterX = (nearX[child] - fromX) * perX, enterY = (nearY[child] - fromY) * perY;
          const Float8 enterZ = (nearZ[child] - fromZ) * perZ;
          const Float8 leaveX = (farX[child] - toX) * farPerX, leaveY = (farY[child] - toY) * farPerY;
          const Float8 leaveZ = (farZ[child] - toZ) * farPerZ;
          Float8 enters = enterX > enterY ? enterX : enterY;
          const Float8 above = enterZ > 0 ? enterZ : Float8{};
          enters = enters > above ? enters : above;
          Float8 leaves = leaveX < leaveY ? leaveX : leaveY;
          const Float8 below = leaveZ < limit ? leaveZ : limit;
          leaves = leaves < below ? leaves : below;
          touching[child] |= (enters <= leaves) & bits;
        }
      }
      Float4 depth{};
      if constexpr (kSorted) {
        const auto leader = static_cast<std::size_t>(std::countr_zero(here.rays));
        const auto along = [&](int axis) RAYSHADE_INLINE {
          return splat(rays.direction[axis][leader / 8][leader % 8]);
        };
        depth = nearX * along(0) + nearY * along(1) + nearZ * along(2);
      }
      const int base = size;
      for (int child = 0; child < 4; ++child) {
        const RaySet touched = anyBits(touching[child]) & here.rays;
        if (touched == 0) continue;
        const Open open{depth[child], node.child[child], touched};
        int at = size++;
        if constexpr (kSorted)
          for (; at > base && stack[at - 1].depth < open.depth; --at) stack[at] = stack[at - 1];
        stack[at] = open;
      }
    }
  }
}

}  // namespace bvh_detail
}  // namespace rayshade
