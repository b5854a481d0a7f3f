// The tracer of a bundle: the core connected by a stack of what waits.  All programs trace with it; what it sees where everything is
// local is the specification that every other way of running must repeat bit for bit.
//
// A bundle of rays is traced, its hits are shaded, and while their transmitted and then their reflected rays are traced, the hits
// wait on a level of their own.  Levels lie in memory, not on the program's stack: how deep rays may go is up to `maxdepth` alone.
//
// Where not everything is local, some rays of the tree go on elsewhere.  They are left at its open ends, with the hits that wait for
// them, and the hits that wait for those, up to the bundle; all the rest of the tree is finished here.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "rayshade/trace/shade_hits.h"

namespace rayshade {

// What of the trees of a bundle could not be finished.
struct OpenEnds {
  static constexpr std::uint32_t kBundle = 0xffffffffu, kLit = 0xffffffffu;
  enum class Branch : std::uint8_t { transmitted, reflected };
  // Who waits for a colour: a hit, or the bundle.
  struct Waiting {
    std::uint32_t hit = kBundle;  // in `hits`
    std::uint32_t ray = 0;        // of the bundle
    Branch branch{};              // of the hit
  };
  struct OpenRay {
    Ray ray;
    NextBlock next;
    Waiting to;
  };
  struct OpenHit {
    Color sum;  // of the lights, unless some light is pending
    ReturnPath back;
    std::optional<Color> transmitted, reflected;  // that are known
    Waiting to;
    std::uint32_t unlit = kLit;  // in `unlit`, if light is pending
  };
  // A hit some of whose light is pending, and the ray that hit.
  struct UnlitHit {
    Ray ray;
    HitLight light;
  };
  std::vector<OpenRay> rays;
  std::vector<OpenHit> hits;  // whoever waits stands behind those for whom it waits
  std::vector<UnlitHit> unlit;

  void clear() {
    rays.clear();
    hits.clear();
    unlit.clear();
  }
};

// Of one thread.
class Tracer {
 public:
  Tracer(LocalSpace& space, const SceneSettings& settings, TraceCounts& counts);
  ~Tracer();

  // What each of at most kBundleSize rays sees.  `begin`, as for traceRays().  Answers with the rays whose colour is not known yet:
  // `open` says what it waits for, none where everything is local.
  RaySet trace(std::span<const Ray> rays, std::span<const double> begin, std::span<Color> seen,
               OpenEnds& open);

 private:
  struct Level;
  struct Expected;
  Level& level(std::size_t depth);
  void shade(std::span<const Ray> rays, std::span<const double> begin, std::span<Expected* const> goals,
             Level& level, OpenEnds& open);
  void finishHits(Level& level, OpenEnds& open);

  LocalSpace& space_;
  const SceneSettings& settings_;
  TraceCounts& counts_;
  FoundHits found_;  // of the bundle that is traced now, as all that follows
  std::array<RayHit, kBundleSize> hits_;
  std::array<ShadedHit, kBundleSize> shaded_;
  ShadingRoom room_;
  std::vector<std::unique_ptr<Level>> levels_;  // kept, so that no ray takes memory
};

}  // namespace rayshade
