// Constructive solid geometry: union, intersection and difference of two solids.
//
// A solid is known by its crossings along a ray, each entering or leaving.  Whether a ray is inside of a solid just
// before a crossing follows from that crossing alone (before an entering one it was outside), so the result can be
// asked for from any t on.  Crossings of both operands that coincide up to rounding are taken as one event: the state
// before it is compared with the state after it.  So A - A is empty, the common face of two touching boxes in a
// union is not there, and coincident faces leave no film.
// differs from rayshade4: which steps over crossings by 1e-5 and speckles where faces coincide.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/intersect/model.h"

namespace rayshade {

struct CsgCrossing {
  double t = kNoHit;            // world units
  ObjectIndex operand = kNone;  // whose surface is seen
  bool entering = true;         // the result, not the operand
};

// The first crossing of the result with t > tMin; `ray` in the space of the operands' definition.
CsgCrossing csgCrossing(const Model& model, const Csg& csg, const LocalRay& ray, const Moment& moment,
                        double tMin);

}  // namespace rayshade
