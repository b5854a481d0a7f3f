// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/scene.h"

namespace rayshade {

void Scene::prepare(const Exposure& exposure, std::uint32_t voxels, unsigned threads) {
  model.prepare(exposure);
  const auto objects = model.store().objectsOf(kWorld);
  regions_.clear();
  if (voxels == 1) {
    tree_ = {};
    blocks_ = BlockMap::everything();
    regions_.push_back(model.regionOf({objects.begin(), objects.end()}, threads));
    all_ = {&model, &regions_[0]};
    return;
  }
  Bounds world;
  for (ObjectIndex object : objects) {
    const Bounds bounds = model.boundsOf(object);
    if (bounds.finite()) world = join(world, bounds);
  }
  tree_ = buildBinTree(world, TreeLimits{voxels, voxels});
  std::vector<Bounds> boxes(cellCount(tree_));  // a voxel is one cell
  std::vector<std::vector<ObjectIndex>> members(boxes.size());
  std::vector<CellId> touched;
  for (ObjectIndex object : objects) {
    touched.clear();
    cellsTouching(tree_, model.boundsOf(object), touched);
    for (CellId cell : touched) {
      const auto at = static_cast<std::size_t>(cell);
      members[at].push_back(object);
      boxes[at] = join(boxes[at], boundsInCell(model.boundsOf(object), tree_, cell));
    }
  }
  // As if each voxel had been fetched.
  all_ = {};
  blocks_ = BlockMap(tree_, boxes, std::vector<bool>(voxelCount(tree_), false), true);
  for (const BlockMap::Block& block : blocks_.blocks())
    regions_.push_back(model.regionOf(std::move(members[static_cast<std::size_t>(block.cell)])));
}

std::size_t Scene::bytes() const {
  std::size_t total = model.bytes();
  for (const Region& region : regions_) total += region.bytes();
  return total;
}

}  // namespace rayshade
