// The sequential tracer: the core connected by recursion.  What it sees is the specification that every other way of running must
// repeat bit for bit; tasks connect the same functions by messages (pvm/trace, pvm/shade).
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
  void trace(std::span<const Ray> rays, std::span<Color> seen) { trace(rays, seen, 0); }

 private:
  struct Stage;
  void trace(std::span<const Ray> rays, std::span<Color> seen, std::size_t depth);

  LocalSpace& space_;
  const SceneSettings& settings_;
  TraceCounts& counts_;
  FoundHits found_;  // of the bundle that is traced now
  ShadingRoom room_;
  std::vector<std::unique_ptr<Stage>>
      stages_;  // by depth of the recursion; kept, so that no ray takes memory
};

}  // namespace rayshade
