// The share of the model that a voxel-trace task holds: the objects that touch its voxels (Reinhard & Jansen, section 3).
//
// Also where cells for the caches of others are cut from it (section 5).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "rayshade/intersect/model.h"
#include "rayshade/space/bintree.h"

namespace rayshade {

class VoxelShare {
 public:
  // Another share comes.
  void forget();
  void take(std::vector<Item>&& items);

  // Places what came in and builds the accelerators, unless nothing has changed.  `owners`: by voxel, which task has it; `self`: this one.
  void prepare(const Exposure& exposure, const BinTree& tree, std::span<const std::uint32_t> owners,
               std::uint32_t self);

  const Model& model() const { return *model_; }
  // All of it, each object once, whatever voxels it lies in.
  const Region& region() const { return region_; }
  bool holds(CellId cell, const BinTree& tree) const {
    return held_.size() == voxelCount(tree) && held_[static_cast<std::size_t>(voxelOfCell(tree, cell))];
  }
  // The objects of a cell that it holds, with all that they refer to.
  std::vector<Item> itemsOf(CellId cell, const BinTree& tree);

  std::size_t objects() const { return model_->store().objectsOf(kWorld).size(); }
  std::uint64_t owned() const {
    return owned_;
  }  // objects whose lowest corner lies in the voxels of this task
  std::size_t leftOut() const { return model_->leftOut(); }
  std::uint64_t bytes() const;

 private:
  std::optional<Model> model_{std::in_place};
  bool itemsAreNew_ = false;
  Region region_;
  std::vector<bool> held_;  // by voxel
  std::uint64_t owned_ = 0;
  std::vector<std::vector<ObjectIndex>> cellObjects_;  // by cell; made when somebody asks for one
};

}  // namespace rayshade
