// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/trace_shadows.h"

#include "rayshade/intersect/placing.h"

namespace rayshade::trace_detail {

void filterShadows(LocalSpace& space, std::vector<OpenShadow>& open, const SceneSettings& settings,
                   TraceCounts& counts) {
  OpenShadow* going[kBundleSize];
  std::size_t count = 0;
  for (OpenShadow& o : open)
    if (o.shadow.last < o.limit) going[count++] = &o;
  while (count > 0) {
    Segment segments[kBundleSize];
    Hit hits[kBundleSize];
    const Model* models[kBundleSize];
    for (std::size_t i = 0; i < count; ++i)
      segments[i] = Segment(going[i]->shadow.ray, going[i]->shadow.last, going[i]->limit);
    // What is not local lies behind the limits.
    nearestLocalHits(space, std::span(segments).first(count), kFromTheStart, RayKind::shadow, hits, models,
                     counts);
    std::size_t left = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!hits[i].found()) continue;
      const ShadowRay& shadow = going[i]->shadow;
      if (!standsBefore(*models[i], shadow.ray.origin, shadow.ray.direction, shadow.ray.moment, hits[i],
                        shadow.distance))
        continue;
      if (passSurface(*models[i], hits[i], going[i]->shadow, settings)) {
        going[left++] = going[i];
      } else {
        going[i]->dark = true;
      }
    }
    count = left;
  }
}

}  // namespace rayshade::trace_detail
