// Rays that are sent together: the answers of visit() and obstruction(), for a bundle at once.
//
// The rays of neighbouring pixels, or from neighbouring points to one light, go through the same nodes of the
// accelerator; together they fetch each node once.  Every ray is tested against objects by the same functions
// as a ray that goes alone, and the nearest hit is the minimum of the same total order, so a bundle changes
// when an answer is found, never the answer.  docs/decisions/0012-bundles.md
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "rayshade/space/model.h"

namespace rayshade {

// The part tMin < t < tEnd of a ray.
struct Segment {
  const Ray* ray = nullptr;
  double tMin = 0, tEnd = kInfinity;
};

// visit() for each of at most kBundleSize segments.
void visitTogether(const Model& model, const Region& region, std::span<const Segment> segments,
                   std::span<Hit> hits);

// obstruction() for each of at most kBundleSize segments.
void obstructionTogether(const Model& model, const Region& region, std::span<const Segment> segments,
                         std::span<Obstruction> met);

}  // namespace rayshade
