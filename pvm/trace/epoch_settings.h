// What every task that traces knows of an epoch.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/messages/control.h"

namespace rayshade {

struct EpochSettings {
  SceneSettings settings;
  BinTree tree;
  Directory directory;
  std::uint32_t cluster = 0;
  Exposure exposure;
  DemandPolicy policy;
  FrameRequest request;
  std::vector<std::uint32_t> cellBytes;  // by cell: what its objects take on the wire; 0: there are none

  TaskId ownerOf(VoxelId voxel) const { return directory.ownerOf(voxel, cluster); }
  bool isEmpty(CellId cell) const { return cellBytes[static_cast<std::size_t>(cell)] == 0; }
  // May cells of others become local to a task that holds voxels?
  bool shadowsFetch() const { return policy.shadows != ShadowPolicy::forward; }
};

}  // namespace rayshade
