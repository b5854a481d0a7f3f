// The core, shared by all programs: what a bundle of rays meets in all that is local, and where the rays go on that may meet
// something else first.
//
// `rayshade`, voxel-trace and pyramid-trace tasks all call traceRays() and traceShadows(); they differ in what is local: everything,
// one's own voxels, fetched cells.  What is not local decides only *where* a ray is resolved, never what it meets: every
// region finds its nearest hit by the same functions, and the nearest of those is taken by the same rule (nearer.h).
// A ray never changes its origin while it travels; all t are measured from where it was born.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "rayshade/trace/local_space.h"
#include "rayshade/trace/trace_counts.h"

namespace rayshade {

// What the rays of a bundle meet first among all that is local, side by side.  Room that is used again.
struct FoundHits {
  std::array<Hit, kBundleSize> hits;
  std::array<const Model*, kBundleSize> models;  // of the hits that there are
  // The rays that are not resolved: something that is not local may be nearer; and where they go on.
  RaySet open = 0;
  std::array<NextBlock, kBundleSize> next;
  std::array<Segment, kBundleSize> segments;  // of the rays, up to what they have met

  bool resolved(std::size_t ray) const { return (open >> ray & 1) == 0; }
};

// Traces at most kBundleSize rays.  `begin[i]`: before this t nothing counts that is not local (it has been looked at); empty: 0 for
// all.
void traceRays(LocalSpace& space, std::span<const Ray> rays, std::span<const double> begin, FoundHits& found,
               TraceCounts& counts);

// The two questions of the core, for segments that are at hand.
//
// The nearest hits among all that is local; the segments' tMax become their t.  Answers with the segments that might meet
// something nearer, from begin[i] on, in a block that is not local.
RaySet nearestLocalHits(LocalSpace& space, std::span<Segment> segments, std::span<const double> begin,
                        RayKind kind, std::span<Hit> hits, std::span<const Model*> models,
                        TraceCounts& counts, Processor processor = thisProcessor());

// What stands on the segments: something opaque, or only something transparent, that is local; `open`: something that is not
// local might, from begin[i] on.
struct LocalOcclusion {
  RaySet opaque = 0, transparent = 0, open = 0;
};
LocalOcclusion localOcclusion(LocalSpace& space, std::span<Segment> segments, std::span<const double> begin,
                              TraceCounts& counts, Processor processor = thisProcessor());

}  // namespace rayshade
