// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/trace.h"

namespace rayshade {

Progress followRay(const BinTree& tree, const Model& model, const VoxelSource& voxels, const Ray& ray,
                   std::uint32_t step, TraceCounts& counts) {
  VoxelWalk walk(tree, ray.origin, ray.direction);
  WalkStep<VoxelId> at;
  for (std::uint32_t i = 0; walk.next(at); ++i) {
    if (i < step) continue;
    const Region* region = voxels.find(at.where);
    if (region == nullptr) {
      if (!voxels.mayMeet(at.where, ray, at.tEnter, at.tExit)) continue;
      return {Progress::State::elsewhere, {}, at.where, i};
    }
    ++counts.visits;
    const Hit hit = nearestHit(model, *region, ray, 0, at.tExit);
    counts.tests += hit.tests;
    if (hit.found()) {
      ++counts.hits;
      return {Progress::State::hit, hit, at.where, i};
    }
  }
  return {};
}

Progress followShadow(const BinTree& tree, const Model& model, const VoxelSource& voxels, ShadowRay& shadow,
                      std::uint32_t step, const SceneSettings& settings, TraceCounts& counts) {
  VoxelWalk walk(tree, shadow.ray.origin, shadow.ray.direction);
  WalkStep<VoxelId> at;
  for (std::uint32_t i = 0; walk.next(at) && at.tEnter < shadow.distance; ++i) {
    if (i < step) continue;
    const Region* region = voxels.find(at.where);
    if (region == nullptr) {
      if (!voxels.mayMeet(at.where, shadow.ray, at.tEnter, std::min(at.tExit, shadow.distance))) continue;
      return {Progress::State::elsewhere, {}, at.where, i};
    }
    ++counts.visits;
    const std::uint32_t before = shadow.tests;
    const bool passes = passShadow(model, *region, shadow, at.tExit, settings);
    counts.tests += shadow.tests - before;
    if (!passes) return {Progress::State::hit, {}, at.where, i};
  }
  return {};
}

}  // namespace rayshade
