// Renders a frame in one process: samples -> primary rays -> the tracer -> rows of pixels.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "rayshade/sampling/sampler.h"
#include "rayshade/scene/camera.h"
#include "rayshade/trace/scene.h"
#include "rayshade/trace/trace_counts.h"

namespace rayshade {

// The exposure of a frame; frames are numbered from picture.firstFrame on, frame 0 opens at picture.startTime.
Exposure exposureOf(const PictureSpec& picture, std::int32_t frame);

// Renders one frame; rows are handed over from top to bottom as they are finished.  `progress` is called often: it may throw.
struct FrameResult {
  TraceCounts counts;
  SamplerCounts samples;
};
FrameResult renderFrame(Scene& scene, const View& view, const PictureSpec& picture, std::int32_t frame,
                        std::uint64_t seed, const std::function<void(const std::vector<Color>&)>& row,
                        const std::function<void(const Sampler&)>& progress = {});

}  // namespace rayshade
