// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/local_trace.h"

#include <optional>
#include <utility>

namespace rayshade {
namespace {

constexpr std::uint32_t kOwnGround = 0xffffffffu;  // in place of the number of a cell

// Walks until `nearestHit(ground, tExit)` is true, the scene or `limit` is left, or something is not at hand.
template <class Visit>
LocalProgress walkLocally(const BinTree& tree, GroundSource& source, const Ray& ray, double limit,
                          std::uint32_t& unit, Visit visit) {
  std::uint32_t passed = 0;
  VoxelWalk voxels(tree, ray.origin, ray.direction);
  std::optional<CellWalk> cells;  // begun when the first voxel is met that is not one's own
  WalkStep<CellId> cell;
  bool cellIsSet = false;
  WalkStep<VoxelId> step;
  for (std::uint32_t i = 0; voxels.next(step) && step.tEnter < limit; ++i) {
    if (const RegionRef own = source.voxel(step.where); own.region != nullptr) {
      if (passed++ < unit) continue;
      ++unit;
      if (visit(own, kOwnGround, step.tExit))
        return {LocalProgress::State::hit, {}, own.model, {}, step.where, i};
      continue;
    }
    if (!source.mayMeet(step.where, ray, step.tEnter, std::min(step.tExit, limit))) continue;
    if (!source.fetches())
      return {LocalProgress::State::missing, {}, nullptr, firstCellOfVoxel(tree, step.where), step.where, i};
    if (!cells) {
      cells.emplace(tree, ray.origin, ray.direction);
      cellIsSet = cells->next(cell);
    }
    while (cellIsSet && voxelOfCell(tree, cell.where) != step.where) cellIsSet = cells->next(cell);
    for (; cellIsSet && voxelOfCell(tree, cell.where) == step.where && cell.tEnter < limit;
         cellIsSet = cells->next(cell)) {
      if (passed < unit) {
        ++passed;
        continue;
      }
      const RegionRef fetched = source.cell(cell.where);
      if (fetched.region == nullptr)
        return {LocalProgress::State::missing, {}, nullptr, cell.where, step.where, i};
      ++passed;
      ++unit;
      if (visit(fetched, static_cast<std::uint32_t>(cell.where), cell.tExit))
        return {LocalProgress::State::hit, {}, fetched.model, cell.where, step.where, i};
    }
  }
  return {};
}

}  // namespace

LocalProgress followLocally(const BinTree& tree, GroundSource& source, const Ray& ray, std::uint32_t& unit,
                            TraceCounts& counts) {
  Hit hit;
  LocalProgress progress = walkLocally(tree, source, ray, kInfinity, unit,
                                       [&](const RegionRef& ground, std::uint32_t, double tExit) {
                                         ++counts.visits;
                                         hit = nearestHit(*ground.model, *ground.region, ray, 0, tExit);
                                         counts.tests += hit.tests;
                                         return hit.found();
                                       });
  progress.hit = hit;
  if (hit.found()) ++counts.hits;
  return progress;
}

LocalProgress followLocally(const BinTree& tree, GroundSource& source, ShadowRay& shadow, std::uint32_t& unit,
                            const SceneSettings& settings, TraceCounts& counts) {
  return walkLocally(tree, source, shadow.ray, shadow.distance, unit,
                     [&](const RegionRef& ground, std::uint32_t id, double tExit) {
                       ++counts.visits;
                       // What stopped the ray before counts in the model that it belongs to.
                       ObjectIndex elsewhere = kNone;
                       if (shadow.occluderGround != id) std::swap(shadow.occluder, elsewhere);
                       const std::uint32_t before = shadow.tests;
                       const bool passes = passShadow(*ground.model, *ground.region, shadow, tExit, settings);
                       counts.tests += shadow.tests - before;
                       if (shadow.occluderGround != id) {
                         if (passes) {
                           shadow.occluder = elsewhere;
                         } else {
                           shadow.occluderGround = id;
                         }
                       }
                       return !passes;
                     });
}

}  // namespace rayshade
