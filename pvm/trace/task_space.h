// What is local to a task: its own voxels, and the cells of others in its object cache.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/trace/epoch_settings.h"
#include "pvm/trace/object_cache.h"
#include "pvm/trace/voxel_share.h"
#include "rayshade/trace/local_space.h"

namespace rayshade {

class TaskSpace final : public LocalSpace {
 public:
  // `share`: null for a task that holds no voxels.
  TaskSpace(const EpochSettings& at, const VoxelShare* share, ObjectCache& cache)
      : at_(at), share_(share), cache_(cache) {}

  // A new epoch.  `cellBounds`: by cell, the padded box around what is in it; `self`: this task.
  void begin(std::span<const Bounds> cellBounds, TaskId self);

  const BinTree& tree() const override { return at_.tree; }
  const BlockMap& blocks() const override { return map_; }
  std::span<const RegionRef> whole(std::size_t rays, RayKind kind) override;
  RegionRef region(std::uint32_t block, std::size_t rays, RayKind kind) override;
  bool isLocal(std::uint32_t block) const override { return cache_.contains(map_.blocks()[block].cell); }

  // Between bundles: makes one accelerator of the cells that have come, if it is time.
  void settle();

  // Look-ups in the cache by shadow rays, a part of all.
  const CacheCounts& shadowLookups() const { return shadowLookups_; }

 private:
  const EpochSettings& at_;
  const VoxelShare* share_;
  ObjectCache& cache_;
  BlockMap map_;
  std::vector<RegionRef> whole_;  // own voxels; once cells are joined, these and all of theirs
  CacheCounts shadowLookups_;
  double cellBytesOfOthers_ = 0;  // on the wire
};

}  // namespace rayshade
