// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/tracer.h"

namespace rayshade {
namespace {

// Rays that go on from hits, and what they see.
struct OnwardBundle {
  std::vector<Ray> rays;
  std::vector<Color*> goals;
  std::array<Color, kBundleSize> seen;

  void clear() {
    rays.clear();
    goals.clear();
  }
  void add(std::optional<Ray>& ray, Color* goal) {
    if (!ray) return;
    rays.push_back(std::move(*ray));
    goals.push_back(goal);
  }
};

}  // namespace

// What is needed at one depth.
struct Tracer::Stage {
  std::array<RayHit, kBundleSize> hits;
  std::array<Color*, kBundleSize> goals;  // of the hits
  std::array<ShadedHit, kBundleSize> shaded;
  std::array<Color, kBundleSize> transmitted, reflected;  // by hit
  OnwardBundle onward;
};

Tracer::Tracer(LocalSpace& space, const SceneSettings& settings, TraceCounts& counts)
    : space_(space), settings_(settings), counts_(counts) {}
Tracer::~Tracer() = default;

void Tracer::trace(std::span<const Ray> rays, std::span<Color> seen, std::size_t depth) {
  if (depth == stages_.size()) stages_.push_back(std::make_unique<Stage>());
  Stage& stage = *stages_[depth];
  traceRays(space_, rays, {}, found_, counts_);
  std::size_t count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (found_.hits[i].found()) {
      stage.hits[count] = {&rays[i], found_.hits[i], found_.models[i]};
      stage.goals[count++] = &seen[i];
    } else {
      seen[i] = missed(rays[i], settings_);
    }
  }
  if (count == 0) return;
  shadeHits(space_, std::span(stage.hits).first(count), settings_, {.sums = true, .records = false},
            stage.shaded, room_, counts_);

  // Neighbours go on together: first all that is transmitted, then all that is reflected.
  const auto goOn = [&](std::optional<Ray> OnwardRays::*ray, std::array<Color, kBundleSize>& colors) {
    OnwardBundle& onward = stage.onward;
    onward.clear();
    for (std::size_t i = 0; i < count; ++i) onward.add(stage.shaded[i].onward.*ray, &colors[i]);
    if (onward.rays.empty()) return;
    trace(onward.rays, onward.seen, depth + 1);
    for (std::size_t i = 0; i < onward.goals.size(); ++i) *onward.goals[i] = onward.seen[i];
  };
  goOn(&OnwardRays::transmitted, stage.transmitted);
  goOn(&OnwardRays::reflected, stage.reflected);
  for (std::size_t i = 0; i < count; ++i) {
    const ShadedHit& at = stage.shaded[i];
    *stage.goals[i] = finish(at.sum, returnPath(*at.ray, at.t, at.onward, settings_), stage.transmitted[i],
                             stage.reflected[i], settings_);
  }
}

}  // namespace rayshade
