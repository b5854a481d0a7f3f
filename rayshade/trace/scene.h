// A scene in one process: all of it is local.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/scene/settings.h"
#include "rayshade/trace/local_space.h"

namespace rayshade {

class Scene final : public LocalSpace {
 public:
  // Places what the model holds during an exposure and builds the accelerators.  Cuts space into `voxels` equal voxels; one is the
  // ordinary case, more let tests compare visits with those of tasks.
  void prepare(const Exposure& exposure, std::uint32_t voxels = 1, unsigned threads = 1);

  Model model;
  SceneSettings settings;

  const BinTree& tree() const override { return tree_; }
  const BlockMap& blocks() const override { return blocks_; }
  std::span<const RegionRef> whole(std::size_t, RayKind) override {
    return std::span(&all_, all_.region != nullptr ? 1 : 0);
  }
  RegionRef region(std::uint32_t block, std::size_t, RayKind) override { return {&model, &regions_[block]}; }
  bool isLocal(std::uint32_t) const override { return true; }
  std::size_t bytes() const;

 private:
  BinTree tree_;
  BlockMap blocks_ = BlockMap::everything();
  std::vector<Region> regions_;  // by block; of all if there is none
  RegionRef all_;                // unless space is cut
};

}  // namespace rayshade
