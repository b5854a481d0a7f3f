// Renders a frame in one process: tiles -> primary rays -> the tracer -> rows of pixels.
//
// Threads share the scene, which nobody writes to, and take tiles; the caller's thread puts the rows together, hands them on and
// traces, too.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "rayshade/events/event_record.h"
#include "rayshade/sampling/sampler.h"
#include "rayshade/scene/camera.h"
#include "rayshade/trace/scene.h"
#include "rayshade/trace/tracer.h"

namespace rayshade {

// The exposure of a frame; frames are numbered from picture.firstFrame on, frame 0 opens at picture.startTime.
Exposure exposureOf(const PictureSpec& picture, std::int32_t frame);

// What is traced by one thread at a time, and what has become of it.
struct Work {
  Tile tile;                      // or, if there are any:
  std::vector<SampleId> samples;  // those that no tile has traced
  TileColors tileColors;
  std::vector<Color> colors;  // by sample
};

// Traces samples one bundle after the other, where everything is local.  Of one thread.
class SampleTracer {
 public:
  SampleTracer(LocalSpace& space, const SceneSettings& settings, const FrameRequest& request,
               std::int32_t frame)
      : tracer_(space, settings, counts), request_(request), frame_(frame) {}

  TraceCounts counts;

  // Throws Interrupted.
  void trace(const SamplingRules& rules, Work& work);

 private:
  TileColors trace(const SamplingRules& rules, const Tile& tile);
  void trace(std::span<const SampleId> samples, std::span<Color> seen);

  Tracer tracer_;
  OpenEnds none_;  // everything is local
  const FrameRequest& request_;
  std::int32_t frame_;
  std::vector<Ray> rays_;
};

// Renders one frame; rows are handed over from top to bottom as they are finished.  `progress` is called often: it may throw.
struct FrameResult {
  TraceCounts counts;
  SamplerCounts samples;
};
// `threads`: with the caller's; the picture is the same for any number.  `records`: of events, one for each thread, or none.
FrameResult renderFrame(Scene& scene, const FrameRequest& request, std::int32_t frame, unsigned threads,
                        const std::function<void(const std::vector<Color>&)>& row,
                        const std::function<void(const Sampler&)>& progress = {},
                        std::span<EventRecord> records = {});

}  // namespace rayshade
