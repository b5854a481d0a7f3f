// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/tracer.h"

namespace rayshade {

// A colour that somebody waits for.
struct Tracer::Expected {
  static constexpr std::uint32_t kNothing = 0xffffffffu;

  Color color;
  std::uint32_t ray = kNothing, hit = kNothing;  // the open end that will bring it

  bool isOpen() const { return ray != kNothing || hit != kNothing; }
  // Tells the open end who waits for it.
  void link(OpenEnds& open, const OpenEnds::Waiting& who) const {
    if (ray != kNothing) open.rays[ray].to = who;
    if (hit != kNothing) open.hits[hit].to = who;
  }
};

// The hits of a bundle, and what is still to be traced for them.
struct Tracer::Level {
  // A hit that waits for what its onward rays see.
  struct WaitingHit {
    WaitingHit() {}  // written out: not cleared before

    Expected* goal = nullptr;  // of its colour
    Color sum;                 // of the lights
    ReturnPath back;
    Expected transmitted, reflected;
    std::uint32_t unlit = OpenEnds::kLit;  // of the open ends, if light is pending
  };
  // Rays that go on from hits, and where what they see goes.
  struct OnwardBundle {
    std::vector<Ray> rays;
    std::vector<Expected*> goals;

    void clear() {
      rays.clear();
      goals.clear();
    }
    void add(std::optional<Ray>& ray, Expected* goal) {
      if (!ray) return;
      rays.push_back(std::move(*ray));
      goals.push_back(goal);
    }
  };

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

// What misses is done, what goes on elsewhere is an open end; the hits are left on the level.
void Tracer::shade(std::span<const Ray> rays, std::span<const double> begin, std::span<Expected* const> goals,
                   Level& level, OpenEnds& open) {
  level.hits.clear();
  traceRays(space_, rays, begin, found_, counts_);
  std::size_t count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!found_.resolved(i)) {
      goals[i]->ray = static_cast<std::uint32_t>(open.rays.size());
      open.rays.push_back({rays[i], found_.next[i], {}});
    } else if (found_.hits[i].found()) {
      hits_[count++] = {&rays[i], found_.hits[i], found_.models[i]};
      level.hits.emplace_back().goal = goals[i];
    } else {
      goals[i]->color = missed(rays[i], settings_);
    }
  }
  if (count == 0) return;
  shadeHits(space_, std::span(hits_).first(count), settings_,
            {.sums = true, .records = !space_.blocks().allHeld()}, shaded_, room_, counts_);
  // Neighbours go on together: first all that is transmitted, then all that is reflected.
  for (std::size_t i = 0; i < count; ++i) {
    ShadedHit& at = shaded_[i];
    Level::WaitingHit& waiting = level.hits[i];
    waiting.sum = at.sum;
    waiting.back = returnPath(*at.ray, at.t, at.onward, settings_);
    level.transmitted.add(at.onward.transmitted, &waiting.transmitted);
    level.reflected.add(at.onward.reflected, &waiting.reflected);
    if (at.pending.empty()) continue;
    waiting.unlit = static_cast<std::uint32_t>(open.unlit.size());
    open.unlit.push_back({*at.ray, std::move(static_cast<HitLight&>(at))});
  }
}

// The colours of hits that have all of their own; the others are open ends.
void Tracer::finishHits(Level& level, OpenEnds& open) {
  for (Level::WaitingHit& hit : level.hits) {
    if (hit.unlit == OpenEnds::kLit && !hit.transmitted.isOpen() && !hit.reflected.isOpen()) {
      hit.goal->color = finish(hit.sum, hit.back, hit.transmitted.color, hit.reflected.color, settings_);
      continue;
    }
    const auto number = static_cast<std::uint32_t>(open.hits.size());
    hit.goal->hit = number;
    OpenEnds::OpenHit& end = open.hits.emplace_back();
    end.sum = hit.sum;
    end.back = hit.back;
    end.unlit = hit.unlit;
    const auto expect = [&](const Expected& expected, bool wanted, OpenEnds::Branch branch,
                            std::optional<Color>& known) {
      expected.link(open, {number, 0, branch});
      if (wanted && !expected.isOpen()) known = expected.color;
    };
    expect(hit.transmitted, hit.back.transmitted, OpenEnds::Branch::transmitted, end.transmitted);
    expect(hit.reflected, hit.back.reflected, OpenEnds::Branch::reflected, end.reflected);
  }
}

RaySet Tracer::trace(std::span<const Ray> rays, std::span<const double> begin, std::span<Color> seen,
                     OpenEnds& open) {
  std::array<Expected, kBundleSize> expected;
  std::array<Expected*, kBundleSize> goals;
  for (std::size_t i = 0; i < rays.size(); ++i) goals[i] = &expected[i];
  shade(rays, begin, std::span(goals).first(rays.size()), level(0), open);
  for (std::size_t depth = 0;;) {
    Level& here = *levels_[depth];
    Level::OnwardBundle& next = !here.transmitted.rays.empty() ? here.transmitted : here.reflected;
    if (!next.rays.empty()) {
      shade(next.rays, {}, next.goals, level(depth + 1), open);
      next.clear();
      ++depth;
      continue;
    }
    finishHits(here, open);
    if (depth-- == 0) break;
  }
  RaySet unknown = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    seen[i] = expected[i].color;
    if (!expected[i].isOpen()) continue;
    unknown |= RaySet{1} << i;
    expected[i].link(open, {OpenEnds::kBundle, static_cast<std::uint32_t>(i), {}});
  }
  return unknown;
}

}  // namespace rayshade
