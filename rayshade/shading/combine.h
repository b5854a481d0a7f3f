// Intersection + all its colours -> one colour.
//
// The order is fixed - ambient, lights from the last to the first of the file, transmitted, reflected, attenuation,
// atmosphere - so it does not matter when a colour came.  No object data is needed (Reinhard & Jansen, section 3:
// "shading must be independent of tracing, and hence be independent of object data").
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/shading/spawn.h"

namespace rayshade {

// All that combine() needs to know of a hit.
struct Intersection {
  Vec3 origin, direction;  // of the ray that hit
  double distance = 0;     // t of the hit
  RandomKey key{};
  std::int32_t sample = 0;
  double extinct = 1;      // of what the ray travelled through, if it counts
  bool inAir = true;       // outside of all media: the atmosphere applies
  Vec3 position, normal, geometricNormal;
  bool smooth = false;
  Surface surface;
  LightStates lit;
  bool transmitted = false, reflected = false;
  Color transmitWeight, reflectWeight;
};

// The colours that come back, each in its own place.
struct Gathered {
  InlineVector<Color, 8> light;  // by light point; what is let through, for those that were asked
  Color transmitted, reflected;
};

Intersection describe(const Ray& ray, double t, const SurfacePoint& at, const Secondary& spawned);

Color combine(const Intersection& hit, const Gathered& gathered, const Setting& setting);

// The colour of a ray that meets nothing.
Color missed(const Ray& ray, const Setting& setting);

template <class Archive>
void serialize(Archive& archive, Intersection& i) {
  archive(i.origin, i.direction, i.distance, i.key, i.sample, i.extinct, i.inAir, i.position, i.normal,
          i.geometricNormal, i.smooth, i.surface, i.lit, i.transmitted, i.reflected, i.transmitWeight, i.reflectWeight);
}

}  // namespace rayshade
