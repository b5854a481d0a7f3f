// How a bundle of rays goes through a Bvh: each box is tested for eight rays at a time.
//
// Rays of one octant go together, near to far along the first of them; as soon as no more than a few of them are left in
// a node each goes on alone.  The tests are those of single rays (bvh.h), so no box is missed.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/accel/bvh.h"

namespace rayshade {
namespace bvh_detail {

[[gnu::always_inline]] inline std::uint32_t anyBits(const Int8& lanes) {
  const auto wide = reinterpret_cast<const Long4&>(lanes);
  const auto either = static_cast<std::uint64_t>(wide[0] | wide[1] | wide[2] | wide[3]);
  return static_cast<std::uint32_t>(either | either >> 32);
}

}  // namespace bvh_detail

// enter() of bvh.cc for eight rays at a time, with the same margins.
template <class Query>
Bvh::Entered Bvh::enterTogether(std::span<const Query> bundle, BoxRays& rays) const {
  constexpr std::size_t kLanes = BoxRays::kLanes;
  Entered entered{0, 0};
  rays.negative[0] = rays.negative[1] = rays.negative[2] = 0;
  for (std::size_t group = 0; group * kLanes < bundle.size(); ++group) {
    const std::size_t first = group * kLanes, count = std::min(kLanes, bundle.size() - first);
    Double8 origin[3], direction[3], tMin, tMax;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const Query& query = bundle[first + std::min(lane, count - 1)];
      origin[0][lane] = query.ray.origin.x;
      origin[1][lane] = query.ray.origin.y;
      origin[2][lane] = query.ray.origin.z;
      direction[0][lane] = query.ray.direction.x;
      direction[1][lane] = query.ray.direction.y;
      direction[2][lane] = query.ray.direction.z;
      tMin[lane] = query.tMin;
      tMax[lane] = query.tMax;
    }
    const auto magnitude = [](const Double8& x) __attribute__((always_inline)) { return x < 0 ? -x : x; };
    const Double8 lengths[3] = {magnitude(direction[0]), magnitude(direction[1]), magnitude(direction[2])};
    Double8 reach = lengths[0] > lengths[1] ? lengths[0] : lengths[1];
    reach = reach > lengths[2] ? reach : lengths[2];
    const Double8 stretch = reinterpret_cast<Double8>(reinterpret_cast<Long8>(reach) & 0x7ff0000000000000);
    const Double8 scale = stretch * scale_;

    Double8 start = tMin * scale, end = tMax * scale;
    Double8 place[3], d[3], exactly[3], away[3];
    // NaN and infinity fail the comparison, too.
    Long8 ordinary = (reach >= kSmallest) & (reach <= kLargest);
    for (int axis = 0; axis < 3; ++axis) {
      place[axis] = (origin[axis] - centre_[axis]) * scale_;
      away[axis] = magnitude(place[axis]);
      ordinary &= (away[axis] <= kFarthest) & (lengths[axis] <= kLargest);
      d[axis] = direction[axis] / stretch;
      exactly[axis] = 1.0 / d[axis];
      const Double8 slack = 0x1p-50 * (1.0 + away[axis]);
      const Double8 toLow = (box_.low[axis] - slack - place[axis]) * exactly[axis];
      const Double8 toHigh = (box_.high[axis] + slack - place[axis]) * exactly[axis];
      const Double8 near = exactly[axis] > 0 ? toLow : toHigh, far = exactly[axis] > 0 ? toHigh : toLow;
      start = near > start ? near : start;
      end = far < end ? far : end;
    }
    const Long8 inside = ordinary & (start <= end);
    start = start < -kLargest ? Double8{} - kLargest : start > kLargest ? Double8{} + kLargest : start;
    rays.limit[group] = __builtin_convertvector((tMax * scale - start) * (1 + 0x1p-22), Float8);
    for (int axis = 0; axis < 3; ++axis) {
      const Double8 step = start * d[axis], p = place[axis] + step;
      const Double8 margin = 0x1p-22 * magnitude(p) + 0x1p-49 * (1.0 + away[axis] + magnitude(step));
      const Float8 at = __builtin_convertvector(p, Float8), moved = __builtin_convertvector(margin, Float8);
      // Off the planes of the box: at least 2^-60, with its sign, which -0 has, too.
      const Long8 sign = reinterpret_cast<Long8>(d[axis]) >> 63;
      const Double8 least = sign != 0 ? Double8{} - 0x1p+60 : Double8{} + 0x1p+60;
      const Double8 inverse = magnitude(d[axis]) > 0x1p-60 ? exactly[axis] : least;
      const Float8 narrow = __builtin_convertvector(inverse, Float8);
      const Float8 forward = narrow > 0 ? moved : -moved;
      rays.nearOrigin[axis][group] = at + forward;
      rays.farOrigin[axis][group] = at - forward;
      rays.nearInverse[axis][group] = narrow * (1 - 0x1p-21f);
      rays.farInverse[axis][group] = narrow * (1 + 0x1p-21f);
      const Float8 along = __builtin_convertvector(d[axis], Float8);
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        rays.direction[axis][first + lane] = along[lane];
        rays.negative[axis] |= static_cast<RaySet>(sign[lane] & 1) << (first + lane);
      }
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      rays.scale[first + lane] = scale[lane];
      rays.start[first + lane] = start[lane];
    }
    for (std::size_t lane = 0; lane < count; ++lane) {
      const RaySet bit = RaySet{1} << (first + lane);
      if (inside[lane] != 0) {
        entered.inside |= bit;
      } else if (ordinary[lane] == 0) {
        const Query& query = bundle[first + lane];
        BoxRay alone;
        const Entry entry = enter(query.ray.origin, query.ray.direction, query.tMin, query.tMax, alone);
        // A ray that stands still is no ordinary one; to look at all is right for any.
        if (entry != Entry::kMissed) entered.everything |= bit;
      }
    }
  }
  return entered;
}

template <bool kSorted, class Query, class Leaf>
void Bvh::traverseTogether(std::span<Query> bundle, Leaf&& leaf) const {
  RaySet waiting = static_cast<RaySet>((std::uint64_t{1} << bundle.size()) - 1);
  const auto visitLeaf = [&](std::uint32_t first, std::uint32_t count, RaySet asking) {
    const RaySet answer = leaf(first, count, asking);
    if constexpr (!kSorted) waiting &= ~answer;
    return answer;
  };
  if (unbounded_ > 0) visitLeaf(inTree_, unbounded_, waiting);
  if (inTree_ == 0) return;
  BoxRays rays;
  const Entered entered = enterTogether(std::span<const Query>(bundle), rays);
  if ((entered.everything & waiting) != 0) visitLeaf(0u, inTree_, entered.everything & waiting);

  struct Open {
    float depth;  // of the near corner along one of the rays
    std::uint32_t child;
    RaySet rays;
  };
  Open stack[kStackSize];
  for (std::uint32_t octant = 0; octant < 8; ++octant) {
    RaySet going = entered.inside;
    for (int axis = 0; axis < 3; ++axis)
      going &= (octant >> axis & 1) != 0 ? rays.negative[axis] : ~rays.negative[axis];
    if (going == 0) continue;
    int size = 0;
    stack[size++] = {0, root_, going};
    while (size > 0) {
      Open here = stack[--size];
      here.rays &= waiting;
      if (here.rays == 0) continue;
      if ((here.child & kLeaf) != 0) {
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
          traverseFrom<kSorted>(here.child, ray, bundle[i].tMax,
                                [&](std::uint32_t first, std::uint32_t count) {
                                  return visitLeaf(first, count, only) != 0 && !kSorted;
                                });
          if constexpr (kSorted) rays.setLimit(i, bundle[i].tMax);
        });
        continue;
      }
      const Node& node = nodes_[here.child];
      const std::size_t x = octant & 1, y = octant >> 1 & 1, z = octant >> 2 & 1;
      const Float4 &nearX = node.plane[3 * x], &nearY = node.plane[1 + 3 * y], &nearZ = node.plane[2 + 3 * z];
      const Float4 &farX = node.plane[3 - 3 * x], &farY = node.plane[4 - 3 * y],
                   &farZ = node.plane[5 - 3 * z];
      Int8 touching[4] = {};  // of each child; a lane has the rays of its place in all groups
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
        for (int lane = 0; lane < 4; ++lane) {
          const Float8 enterX = (nearX[lane] - fromX) * perX, enterY = (nearY[lane] - fromY) * perY;
          const Float8 enterZ = (nearZ[lane] - fromZ) * perZ;
          const Float8 leaveX = (farX[lane] - toX) * farPerX, leaveY = (farY[lane] - toY) * farPerY;
          const Float8 leaveZ = (farZ[lane] - toZ) * farPerZ;
          Float8 enters = enterX > enterY ? enterX : enterY;
          const Float8 above = enterZ > 0 ? enterZ : Float8{};
          enters = enters > above ? enters : above;
          Float8 leaves = leaveX < leaveY ? leaveX : leaveY;
          const Float8 below = leaveZ < limit ? leaveZ : limit;
          leaves = leaves < below ? leaves : below;
          touching[lane] |= (enters <= leaves) & bits;
        }
      }
      Float4 depth{};
      if constexpr (kSorted) {
        const auto leader = static_cast<std::size_t>(std::countr_zero(here.rays));
        depth = nearX * splat(rays.direction[0][leader]) + nearY * splat(rays.direction[1][leader]) +
                nearZ * splat(rays.direction[2][leader]);
      }
      const int base = size;
      for (int lane = 0; lane < 4; ++lane) {
        const RaySet touched = bvh_detail::anyBits(touching[lane]) & here.rays;
        if (touched == 0) continue;
        const Open open{depth[lane], node.child[lane], touched};
        int at = size++;
        if constexpr (kSorted)
          for (; at > base && stack[at - 1].depth < open.depth; --at) stack[at] = stack[at - 1];
        stack[at] = open;
      }
    }
  }
}

}  // namespace rayshade
