// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/voxel_share.h"

#include "rayshade/scene/extract.h"

namespace rayshade {

void VoxelShare::forget() {
  model_.emplace();
  itemsAreNew_ = true;
  region_ = {};
  held_.clear();
}

void VoxelShare::take(std::vector<Item>&& items) {
  model_->take(std::move(items));
  itemsAreNew_ = true;
}

void VoxelShare::prepare(const Exposure& exposure, const BinTree& tree, std::span<const std::uint32_t> owners,
                         std::uint32_t self) {
  // The host never sends another tree without items, but a message may come from anybody.
  if (!itemsAreNew_ && held_.size() == voxelCount(tree)) return;
  itemsAreNew_ = false;
  model_->prepare(exposure);
  cellObjects_.clear();
  held_.clear();
  for (std::uint32_t voxel = 0; voxel < voxelCount(tree); ++voxel) held_.push_back(owners[voxel] == self);
  const auto objects = model_->store().objectsOf(kWorld);
  std::vector<VoxelId> touched;
  owned_ = 0;
  for (ObjectIndex object : objects) {
    touched.clear();
    voxelsTouching(tree, model_->boundsOf(object), touched);
    // Every object belongs to the first voxel that it touches; there it counts.
    if (!touched.empty() && held_[static_cast<std::size_t>(touched.front())]) ++owned_;
  }
  region_ = {};
  region_ = model_->regionOf({objects.begin(), objects.end()});
}

// Which objects lie in which cell is found out when the first one is asked for.
std::vector<Item> VoxelShare::itemsOf(CellId cell, const BinTree& tree) {
  if (cellObjects_.empty()) {
    cellObjects_.resize(cellCount(tree));
    std::vector<CellId> cells;
    for (ObjectIndex object : model_->store().objectsOf(kWorld)) {
      cells.clear();
      cellsTouching(tree, model_->boundsOf(object), cells);
      for (CellId touched : cells)
        if (held_[static_cast<std::size_t>(voxelOfCell(tree, touched))])
          cellObjects_[static_cast<std::size_t>(touched)].push_back(object);
    }
  }
  Extract extract(model_->store());
  for (ObjectIndex object : cellObjects_[static_cast<std::size_t>(cell)]) extract.add(object);
  return std::move(extract.items);
}

std::uint64_t VoxelShare::bytes() const { return model_->bytes() + region_.bytes(); }

}  // namespace rayshade
