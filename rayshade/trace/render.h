// The sequential renderer: the specification of what every other way of running must repeat bit for bit.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "rayshade/image/picture_file.h"
#include "rayshade/scene/camera.h"
#include "rayshade/shading/combine.h"
#include "rayshade/trace/trace.h"

namespace rayshade {

// A scene that is ready to be rendered in one process.
class Scene : public VoxelSource {
 public:
  // Cuts space into `voxels` equal voxels; one is the ordinary case, more let tests compare visits with those of tasks.
  void prepare(const Exposure& exposure, std::uint32_t voxels = 1);

  Model model;
  SceneSettings settings;
  BinTree tree;

  const Region* find(VoxelId voxel) const override { return &regions_[static_cast<std::size_t>(voxel)]; }
  bool undivided() const { return regions_.size() == 1; }
  const Region& space() const { return regions_[0]; }  // all of it, if undivided
  std::size_t bytes() const;

 private:
  std::vector<Region> regions_;
};

// The exposure of a frame; frames are numbered from picture.firstFrame on, frame 0 opens at picture.startTime.
Exposure exposureOf(const PictureSpec& picture, std::int32_t frame);

// Renders one frame; rows are handed over from top to bottom as they are finished.
struct FrameResult {
  TraceCounts counts;
  SamplerCounts samples;
};
FrameResult renderFrame(const Scene& scene, const View& view, const PictureSpec& picture, std::int32_t frame,
                        std::uint64_t seed, const std::function<void(const std::vector<Color>&)>& row);

}  // namespace rayshade
