// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/voxel_bounds.h"

namespace rayshade {

Bounds boundsInCell(const Bounds& object, const BinTree& tree, CellId cell) {
  const Bounds box = boundsOf(tree, cell);
  Bounds part;
  for (int axis = 0; axis < 3; ++axis) {
    part.low[axis] = std::max(object.low[axis], box.low[axis]);
    part.high[axis] = std::min(object.high[axis], box.high[axis]);
  }
  return padded(part);
}

VoxelBounds::VoxelBounds(const BinTree& tree, std::span<const Bounds> cells) {
  std::vector<Bounds> full;
  std::uint32_t cell = 0;
  for (std::uint32_t voxel = 0; voxel < voxelCount(tree); ++voxel) {
    const std::uint32_t end = voxel + 1 < voxelCount(tree)
                                  ? static_cast<std::uint32_t>(firstCellOfVoxel(tree, VoxelId{voxel + 1}))
                                  : cellCount(tree);
    full.clear();
    for (; cell < end; ++cell)
      if (!cells[cell].empty()) full.push_back(cells[cell]);
    voxels_.emplace_back(full);
  }
}

}  // namespace rayshade
