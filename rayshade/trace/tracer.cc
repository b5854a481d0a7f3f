// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/tracer.h"

namespace rayshade {
namespace {

// Rays that go on from hits, and where what they see goes.
struct OnwardBundle {
  std::vector<Ray> rays;
  std::vector<Color*> goals;

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

// A hit whose lights have been added.
struct WaitingHit {
  Color* goal = nullptr;  // of its colour
  Color sum;
  ReturnPath back;
  Color transmitted, reflected;  // when they have come
};

}  // namespace

// The hits of a bundle, and what is still to be traced for them.
struct Tracer::Level {
  std::vector<WaitingHit> hits;
  OnwardBundle transmitted, reflected;
};

Tracer::Tracer(LocalSpace& space, const SceneSettings& settings, TraceCounts& counts)
    : space_(space), settings_(settings), counts_(counts) {}
Tracer::~Tracer() = default;

Tracer::Level& Tracer::level(std::size_t depth) {
  if (depth == levels_.size()) levels_.push_back(std::make_unique<Level>());
  return *levels_[depth];
}

// What misses is done; the hits are left on the level.
void Tracer::shade(std::span<const Ray> rays, std::span<Color* const> goals, Level& level) {
  level.hits.clear();
  traceRays(space_, rays, {}, found_, counts_);
  std::size_t count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (found_.hits[i].found()) {
      hits_[count++] = {&rays[i], found_.hits[i], found_.models[i]};
      level.hits.emplace_back().goal = goals[i];
    } else {
      *goals[i] = missed(rays[i], settings_);
    }
  }
  if (count == 0) return;
  shadeHits(space_, std::span(hits_).first(count), settings_, {.sums = true, .records = false}, shaded_,
            room_, counts_);
  // Neighbours go on together: first all that is transmitted, then all that is reflected.
  for (std::size_t i = 0; i < count; ++i) {
    ShadedHit& at = shaded_[i];
    WaitingHit& waiting = level.hits[i];
    waiting.sum = at.sum;
    waiting.back = returnPath(*at.ray, at.t, at.onward, settings_);
    level.transmitted.add(at.onward.transmitted, &waiting.transmitted);
    level.reflected.add(at.onward.reflected, &waiting.reflected);
  }
}

void Tracer::trace(std::span<const Ray> rays, std::span<Color> seen) {
  std::array<Color*, kBundleSize> goals;
  for (std::size_t i = 0; i < rays.size(); ++i) goals[i] = &seen[i];
  std::size_t depth = 0;
  shade(rays, std::span(goals).first(rays.size()), level(0));
  for (;;) {
    Level& here = *levels_[depth];
    OnwardBundle& next = !here.transmitted.rays.empty() ? here.transmitted : here.reflected;
    if (!next.rays.empty()) {
      shade(next.rays, next.goals, level(depth + 1));
      next.clear();
      ++depth;
      continue;
    }
    for (const WaitingHit& hit : here.hits)
      *hit.goal = finish(hit.sum, hit.back, hit.transmitted, hit.reflected, settings_);
    if (depth-- == 0) return;
  }
}

}  // namespace rayshade
