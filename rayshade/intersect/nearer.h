// The rule for the nearer of two hits, once: the smaller t, and at exactly the same t the smaller precedence.
//
// It is a total order of what a ray meets, a property of the objects alone; so neither the order of testing, nor bundles, nor the
// way in which space was cut can change which hit is taken.  docs/decisions/0005-order-of-coincident-hits.md
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/intersect/model.h"

namespace rayshade {

// Is an object that is met at `t` taken instead of `best`, which was found at `limit`?  `best` null: nothing was found yet, and what
// is met at `limit` or behind it does not count.  Distances in the same units; NaN and kNoHit are never nearer.
inline bool nearer(double t, const PlacedObject& object, double limit, const PlacedObject* best) {
  if (t < limit) return true;
  return t == limit && best != nullptr && precedence(object) < precedence(*best);
}

}  // namespace rayshade
