// A point of a placed shape, and how far off it may be: what transforms do to roundings.
//
// A ray meets a placed shape in the shape's space, where the inverse maps take it; the point that is found goes out by the forward
// maps, and a ray that starts there comes in again by the inverse ones.  Both are products of rounded factors: what goes far away
// and comes back (a pivot) or is stretched and shrunk again does not return to where it was.  So the way is gone, out and in, and
// what it misses by is seen, with a bound for the roundings of each step, axis by axis: a thin axis must not pay for a long one.
//
//   error(p M) <= |M| error(p) + gamma (|M| |p| + |origin|)        by component
//
// Source: Higham, Accuracy and Stability of Numerical Algorithms, section 3.1; Pharr, Jakob & Humphreys, Physically Based
// Rendering, section 6.8.5.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "rayshade/intersect/model.h"

namespace rayshade {

// For a point of an object inside of several spaces, whose maps lead outwards (the innermost first): at most how far from `local` a
// ray finds itself that starts where it is outside of all of them, at `outside`; by axis of the inner space.
Vec3 errorOfWay(std::span<const Affine> maps, Vec3 local, Vec3 outside);

struct PlacedPoint {
  ShapePoint shape;  // in the shape's space
  Affine toWorld;
  bool placed = false;   // toWorld is not the identity
  Vec3 position;         // world
  Vec3 geometricNormal;  // world, unit, as the shape has it
  double error = 0;      // the surface is at most so far from `position`, along its normal      [world units]
};

// What is at t on a ray, at the end of a path.
PlacedPoint placedPoint(const Model& model, const HitPath& path, const Ray& ray, double t);

// A light may lie in a surface, or on it; both have roundings, so who asks whether the surface is in front of the light has to know
// them.  Does a ray that ends at `end` end in what it meets a little before, at hit.t, and not behind it?
bool endsIn(const Model& model, Vec3 origin, Vec3 direction, const Moment& moment, const Hit& hit,
            double end);

// Does what a ray meets before `end`, where a light is, stand before the light?  Only what is met near the end needs to be looked at.
inline bool standsBefore(const Model& model, Vec3 origin, Vec3 direction, const Moment& moment,
                         const Hit& hit, double end) {
  if (hit.t < end * (1 - 0x1p-10) - 0x1p-20 * maxAbs(origin)) [[likely]]
    return true;
  return !endsIn(model, origin, direction, moment, hit, end);
}

}  // namespace rayshade
