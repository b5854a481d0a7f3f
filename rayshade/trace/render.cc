// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/render.h"

#include "rayshade/trace/tracer.h"

namespace rayshade {

Exposure exposureOf(const PictureSpec& picture, std::int32_t frame) {
  const double opens = picture.startTime + frame * picture.frameLength;
  return {opens, opens + std::max(picture.shutter, 0.0), frame};
}

FrameResult renderFrame(Scene& scene, const View& view, const PictureSpec& picture, std::int32_t frame,
                        std::uint64_t seed, const std::function<void(const std::vector<Color>&)>& row,
                        const std::function<void(const Sampler&)>& progress) {
  Sampler sampler(picture, seed, static_cast<std::uint32_t>(frame), Sampler::Guessing::no);
  FrameResult result;
  Tracer tracer(scene, scene.settings, result.counts);
  std::vector<Color> finished;
  SampleId samples[kBundleSize];
  Color seen[kBundleSize];
  std::vector<Ray> rays;
  while (!sampler.finished()) {
    while (const std::size_t count = sampler.next(samples)) {
      result.counts.primaryRays += count;
      primaryRays(view, picture, seed, frame, std::span(samples).first(count), rays);
      tracer.trace(rays, seen);
      for (std::size_t i = 0; i < count; ++i) sampler.supply(samples[i], seen[i]);
      if (progress) progress(sampler);
    }
    while (sampler.takeRow(finished)) row(finished);
  }
  result.samples = sampler.counts();
  return result;
}

}  // namespace rayshade
