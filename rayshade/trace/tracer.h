// The sequential tracer: the core connected by a stack of what waits.  What it sees is the specification that every other way of
// running must repeat bit for bit; tasks connect the same functions by messages (pvm/trace, pvm/shade).
//
// A bundle of rays is traced, its hits are shaded, and while their transmitted and then their reflected rays are traced, the hits
// wait on a level of their own.  Levels lie in memory, not on the program's stack: how deep rays may go is up to `maxdepth` alone.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "rayshade/trace/shade_hits.h"

namespace rayshade {

// Of one thread.  Everything must be local.
class Tracer {
 public:
  Tracer(LocalSpace& space, const SceneSettings& settings, TraceCounts& counts);
  ~Tracer();

  // What each of at most kBundleSize rays sees.
  void trace(std::span<const Ray> rays, std::span<Color> seen);

 private:
  struct Level;
  Level& level(std::size_t depth);
  void shade(std::span<const Ray> rays, std::span<Color* const> goals, Level& level);

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
