// Rays that are sent together: what a bundle meets in one region, found at once.
//
// The rays of neighbouring pixels, or from neighbouring points to one light, go through the same nodes of the
// accelerator; together they fetch each node once.  Every ray is tested against objects by the same functions
// as a ray that goes alone, and the nearest hit is the minimum of the same total order, so a bundle changes
// when an answer is found, never the answer.  docs/decisions/0012-bundles.md
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "rayshade/intersect/model.h"

namespace rayshade {

// The part tMin < t < tMax of a ray.
struct Segment : RayQuery {
  Segment() = default;
  Segment(const Ray& ray, double tMin = 0, double tMax = kInfinity)
      : RayQuery{{ray.origin, ray.direction, 1}, tMin, tMax}, moment(ray.moment) {}
  Segment(Vec3 origin, Vec3 direction, double tMax, Moment moment)
      : RayQuery{{origin, direction, 1}, 0, tMax}, moment(moment) {}

  Moment moment;
};

// nearestHit() for each of at most kBundleSize segments, whose tMax become the t of the hits.
void nearestHits(const Model& model, const Region& region, std::span<Segment> segments, std::span<Hit> hits,
                 Processor processor = thisProcessor());

// Is there something opaque between tMin and tMax, where a light is?  What the light lies in does not count (placing.h).  `transparent` tells whether something else was met, as far as was looked.
struct Occlusion {
  bool opaque = false, transparent = false;
  std::uint32_t tests = 0;  // objects that were tested
};
// For each of at most kBundleSize segments.
void occlusions(const Model& model, const Region& region, std::span<Segment> segments,
                std::span<Occlusion> met, Processor processor = thisProcessor());

}  // namespace rayshade
