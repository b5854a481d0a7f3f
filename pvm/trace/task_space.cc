// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/task_space.h"

namespace rayshade {

void TaskSpace::begin(std::span<const Bounds> cellBounds, TaskId self) {
  std::vector<bool> held(voxelCount(at_.tree));
  if (share_ != nullptr)
    for (std::uint32_t voxel = 0; voxel < held.size(); ++voxel)
      held[voxel] = at_.ownerOf(VoxelId{voxel}) == self;
  map_ = BlockMap(at_.tree, cellBounds, std::move(held), share_ == nullptr || at_.shadowsFetch());
}

RegionRef TaskSpace::region(std::uint32_t block, std::size_t rays, RayKind kind) {
  const BlockMap::Block& b = map_.blocks()[block];
  if (b.held) return {&share_->model(), share_->region(b.voxel)};
  const RegionRef cached = cache_.find(b.cell, rays);
  if (kind == RayKind::shadow) {
    shadowLookups_.asked += rays;
    if (cached.region != nullptr) shadowLookups_.hits += rays;
  }
  return cached;
}

}  // namespace rayshade
