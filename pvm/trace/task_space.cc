// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/task_space.h"

namespace rayshade {

void TaskSpace::begin(std::span<const Bounds> cellBounds, TaskId self) {
  std::vector<bool> held(voxelCount(at_.tree));
  if (share_ != nullptr)
    for (std::uint32_t voxel = 0; voxel < held.size(); ++voxel)
      held[voxel] = at_.ownerOf(VoxelId{voxel}) == self;
  cellBytesOfOthers_ = 0;
  for (std::uint32_t cell = 0; cell < cellCount(at_.tree); ++cell)
    if (!held[static_cast<std::size_t>(voxelOfCell(at_.tree, CellId{cell}))])
      cellBytesOfOthers_ += at_.cellBytes[cell];
  whole_.clear();
  if (share_ != nullptr) whole_.push_back({&share_->model(), &share_->region()});
  map_ = BlockMap(at_.tree, cellBounds, std::move(held), share_ == nullptr || at_.shadowsFetch());
}

RegionRef TaskSpace::region(std::uint32_t block, std::size_t rays, RayKind kind) {
  const RegionRef cached = cache_.find(map_.blocks()[block].cell, rays);
  if (kind == RayKind::shadow) {
    shadowLookups_.lookups += rays;
    if (cached.region != nullptr) shadowLookups_.hits += rays;
  }
  return cached;
}

std::span<const RegionRef> TaskSpace::whole(std::size_t rays, RayKind kind) {
  if (cache_.anyJoined()) {
    cache_.countJoined(rays);
    if (kind == RayKind::shadow) {
      shadowLookups_.lookups += rays;
      shadowLookups_.hits += rays;
    }
  }
  return whole_;
}

void TaskSpace::settle() {
  if (!map_.fetches()) return;
  const Model* const own = share_ != nullptr ? &share_->model() : nullptr;
  const double all = kCacheBytesPerWireByte * cellBytesOfOthers_ +
                     (own != nullptr ? static_cast<double>(share_->bytes()) : 0);
  if (!cache_.join(all, at_.exposure, own)) return;
  std::vector<bool> joined;
  for (const BlockMap::Block& block : map_.blocks()) joined.push_back(cache_.isJoined(block.cell));
  map_.join(joined);
  whole_ = {{&cache_.joinedModel(), &cache_.joinedRegion()}};
}

}  // namespace rayshade
