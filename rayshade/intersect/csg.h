// Constructive solid geometry: union, intersection and difference of solids.
//
// A solid is known by its crossings along a ray, each entering or leaving.  Whether a ray is inside of an operand just before a
// crossing follows from that crossing alone (before an entering one it was outside), so open pieces that fit together are solids,
// too.  All crossings of all leaves that the ray may meet are found once and gone through in order of t.  Crossings of different
// leaves that coincide up to rounding are one event: the state before it is compared with the state after it.  So A - A is empty,
// the common face of two touching boxes in a union is not there, and coincident faces leave no film.
// The crossings of a ray are a function of that ray alone: asking from any t on gives the same ones.
// differs from rayshade4: which steps over crossings by 1e-5 and speckles where faces coincide, takes a ray that does not cross a
// plane to be outside of it, and knows of no bounds of open pieces.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/intersect/model.h"

namespace rayshade {

// A crossing of the result.
struct Crossing {
  double t = kNoHit;       // world units
  std::uint32_t leaf = 0;  // whose surface is seen; of coincident ones the first in the file
  bool entering = true;    // the result, not the leaf
  bool exists() const { return t < kNoHit; }
};

// The first crossing of the result with t > tMin >= 0; `ray` in the space of the operands' definition.
Crossing firstCrossing(const Model& model, const Solid& solid, const LocalRay& ray, const Moment& moment,
                       double tMin);
// The one at t, where a ray has been found to cross.
Crossing crossingAt(const Model& model, const Solid& solid, const LocalRay& ray, const Moment& moment,
                    double t);

}  // namespace rayshade
