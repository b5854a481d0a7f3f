// Random shapes, and rays at places of them where rounding hurts: corners, edges, ends, tangents.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/shapes/all.h"
#include "tests/support/oracle/hard_random.h"

namespace rayshade {

// Each is made anew; its size comes back.
double make(HardRandom& random, Sphere& s);
double make(HardRandom& random, Box& b);
double make(HardRandom& random, Plane& p);
double make(HardRandom& random, Disc& d);
double make(HardRandom& random, Cylinder& c);
double make(HardRandom& random, Cone& c);
double make(HardRandom& random, Triangle& t);
double make(HardRandom& random, PhongTriangle& t);
double make(HardRandom& random, TriangleUv& t);
double make(HardRandom& random, Polygon& p);
double make(HardRandom& random, Torus& t);
double make(HardRandom& random, Blob& b);
double make(HardRandom& random, HeightField& h);

// A place on it.
struct Spot {
  Vec3 point, normal;
};

Spot spotOn(HardRandom& random, const Sphere& s);
Spot spotOn(HardRandom& random, const Box& b);
Spot spotOn(HardRandom& random, const Plane& p);
Spot spotOn(HardRandom& random, const Disc& d);
Spot spotOn(HardRandom& random, const Cylinder& c);
Spot spotOn(HardRandom& random, const Cone& c);
Spot spotOn(HardRandom& random, const Triangle& t);
Spot spotOn(HardRandom& random, const PhongTriangle& t);
Spot spotOn(HardRandom& random, const TriangleUv& t);
Spot spotOn(HardRandom& random, const Polygon& p);
Spot spotOn(HardRandom& random, const Torus& t);
Spot spotOn(HardRandom& random, const Blob& b);
Spot spotOn(HardRandom& random, const HeightField& h);

template <class S>
LocalRay rayAt(HardRandom& random, const S& shape, double size) {
  const Spot spot = spotOn(random, shape);
  Vec3 target = spot.point;
  switch (random.below(4)) {
    case 0:
      target = target + random.sign() * size * random.magnitude(1e-17, 1e-1) * spot.normal;
      break;
    case 1:
      for (int axis = 0; axis < 3; ++axis)
        if (random.oneIn(2))
          target[axis] += random.sign() * 2 * kUnit * std::max(std::abs(target[axis]), size);
      break;
  }
  Vec3 direction;
  switch (random.below(4)) {
    case 0:  // along the surface, or nearly so
      direction =
          normalize(random.across(spot.normal) +
                    (random.oneIn(4) ? 0 : random.sign() * random.magnitude(1e-17, 1e-1)) * spot.normal);
      break;
    case 1:
      direction = random.axisOrNearly();
      break;
    case 2: {  // through another spot of it
      const Vec3 way = target - spotOn(random, shape).point;
      direction = way == Vec3{} ? random.direction() : normalize(way);
      break;
    }
    default:
      direction = random.direction();
  }
  const double distance =
      random.oneIn(2) ? size * random.magnitude(1e-3, 1e3) : random.magnitude(kLeast, kMost);
  const Vec3 origin = target - distance * direction;
  // Half of them aim again from where rounding put the origin.
  if (random.oneIn(2) && target != origin) direction = normalize(target - origin);
  return {origin, direction};
}

}  // namespace rayshade
