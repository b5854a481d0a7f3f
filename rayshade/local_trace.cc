// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/local_trace.h"

namespace rayshade {
namespace {

// Walks until `visit(ground, tExit)` is true, the scene or `limit` is left, or something is not at hand.
template <class Visit>
LocalProgress walkLocally(const BinTree& tree, GroundSource& source, Vec3 origin, Vec3 direction,
                          double limit, std::uint32_t& unit, Visit visit) {
  std::uint32_t passed = 0;
  VoxelWalk voxels(tree, origin, direction);
  CellWalk cells(tree, origin, direction);
  WalkStep<CellId> cell;
  bool cellIsSet = cells.next(cell);
  WalkStep<VoxelId> step;
  for (std::uint32_t i = 0; voxels.next(step) && step.tEnter < limit; ++i) {
    if (const Ground own = source.voxel(step.where); own.region != nullptr) {
      if (passed++ < unit) continue;
      ++unit;
      if (visit(own, step.tExit)) return {LocalProgress::State::hit, {}, own.model, {}, step.where, i};
      continue;
    }
    while (cellIsSet && voxelOfCell(tree, cell.where) != step.where) cellIsSet = cells.next(cell);
    for (; cellIsSet && voxelOfCell(tree, cell.where) == step.where && cell.tEnter < limit;
         cellIsSet = cells.next(cell)) {
      if (passed < unit) {
        ++passed;
        continue;
      }
      const Ground fetched = source.cell(cell.where);
      if (fetched.region == nullptr)
        return {LocalProgress::State::missing, {}, nullptr, cell.where, step.where, i};
      ++passed;
      ++unit;
      if (visit(fetched, cell.tExit))
        return {LocalProgress::State::hit, {}, fetched.model, cell.where, step.where, i};
    }
  }
  return {};
}

}  // namespace

LocalProgress followLocally(const BinTree& tree, GroundSource& source, const Ray& ray, std::uint32_t& unit,
                            TraceCounts& counts) {
  Hit hit;
  LocalProgress progress = walkLocally(tree, source, ray.origin, ray.direction, kInfinity, unit,
                                       [&](const Ground& ground, double tExit) {
                                         ++counts.visits;
                                         hit = visit(*ground.model, *ground.region, ray, 0, tExit);
                                         return hit.found();
                                       });
  progress.hit = hit;
  if (hit.found()) ++counts.hits;
  return progress;
}

LocalProgress followLocally(const BinTree& tree, GroundSource& source, ShadowRay& shadow, std::uint32_t& unit,
                            const Setting& setting, TraceCounts& counts) {
  return walkLocally(tree, source, shadow.ray.origin, shadow.ray.direction, shadow.distance, unit,
                     [&](const Ground& ground, double tExit) {
                       ++counts.visits;
                       shadow.occluder = kNone;  // an object of another model
                       return !passShadow(*ground.model, *ground.region, shadow, tExit, setting);
                     });
}

}  // namespace rayshade
