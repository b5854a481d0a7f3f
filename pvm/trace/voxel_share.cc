// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/voxel_share.h"

#include "rayshade/scene/extract.h"

namespace rayshade {

void VoxelShare::forget() {
  model_.emplace();
  itemsAreNew_ = true;
  regions_.clear();
}

void VoxelShare::take(std::vector<Item>&& items) {
  model_->take(std::move(items));
  itemsAreNew_ = true;
}

void VoxelShare::prepare(const Exposure& exposure, const BinTree& tree, std::span<const std::uint32_t> owners,
                         std::uint32_t self) {
  // The host never sends another tree without items, but a message may come from anybody.
  if (!itemsAreNew_ && regions_.size() == voxelCount(tree)) return;
  itemsAreNew_ = false;
  model_->prepare(exposure);
  cellObjects_.clear();
  std::vector<std::vector<ObjectIndex>> members(voxelCount(tree));
  std::vector<VoxelId> touched;
  owned_ = 0;
  for (ObjectIndex object : model_->store().objectsOf(kWorld)) {
    touched.clear();
    voxelsTouching(tree, model_->boundsOf(object), touched);
    // Every object belongs to the first voxel that it touches; there it counts.
    if (!touched.empty() && owners[static_cast<std::size_t>(touched.front())] == self) ++owned_;
    for (VoxelId voxel : touched)
      if (owners[static_cast<std::size_t>(voxel)] == self)
        members[static_cast<std::size_t>(voxel)].push_back(object);
  }
  regions_.clear();
  for (std::size_t voxel = 0; voxel < members.size(); ++voxel)
    regions_.push_back(owners[voxel] == self
                           ? std::make_unique<Region>(model_->regionOf(std::move(members[voxel])))
                           : nullptr);
}

// Which objects lie in which cell of a voxel is found out when the first one is asked for.
std::optional<std::vector<Item>> VoxelShare::itemsOf(CellId cell, const BinTree& tree) {
  const VoxelId voxel = voxelOfCell(tree, cell);
  const Region* held = region(voxel);
  if (held == nullptr) return std::nullopt;
  const auto key = static_cast<std::uint32_t>(cell);
  if (!cellObjects_.contains(key)) {
    std::vector<CellId> cells;
    for (const Target& target : held->objects) {
      cells.clear();
      cellsTouching(tree, model_->boundsOf(target.object), cells);
      for (CellId touched : cells)
        if (voxelOfCell(tree, touched) == voxel)
          cellObjects_[static_cast<std::uint32_t>(touched)].push_back(target.object);
    }
    cellObjects_[key];
  }
  Extract extract(model_->store());
  for (ObjectIndex object : cellObjects_[key]) extract.add(object);
  return std::move(extract.items);
}

std::uint64_t VoxelShare::bytes() const {
  std::uint64_t bytes = model_->bytes();
  for (const auto& region : regions_)
    if (region) bytes += region->bytes();
  return bytes;
}

}  // namespace rayshade
