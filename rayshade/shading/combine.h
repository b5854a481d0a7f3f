// Intersection + all its colours -> one colour.
//
// The order is fixed - ambient, lights from the last to the first of the file, transmitted, reflected, attenuation,
// atmosphere - so it does not matter when a colour came.  No object data is needed (Reinhard & Jansen, section 3:
// "shading must be independent of tracing, and hence be independent of object data").
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/shading/spawn.h"

namespace rayshade {

// All that combine() needs to know of a hit, and nothing else: what this scene does not ask for stays at its usual value,
// which costs a bit on the wire.
struct Intersection {
  Vec3 origin, direction;  // of the ray that hit; the origin if the atmosphere asks for it
  double distance = 0;     // t of the hit, if atmosphere or attenuation ask for it
  RandomKey key{};
  std::int32_t sample = 0;
  double extinct = 1;  // of what the ray travelled through, if it counts
  bool inAir = true;   // outside of all media: the atmosphere applies
  Vec3 position, normal;
  bool smooth = false;  // the normal is interpolated: then the geometric one counts too
  Vec3 geometricNormal;
  Surface surface;  // what is seen of it: neither its index nor how much it reflects
  LightStates lit;
  bool transmitted = false, reflected = false;
  Color transmitWeight, reflectWeight;
};

// The colours that come back, each in its own place.
struct Gathered {
  InlineVector<Color, 4> light;  // by light point; what is let through, for those that were asked
  Color transmitted, reflected;
};

Intersection describe(const Ray& ray, double t, const SurfacePoint& at, const Secondary& spawned,
                      const Setting& setting);

// How a hit is turned towards lights and viewer.
struct Facing {
  Vec3 normal, geometricNormal;
  bool smooth = false;
  Vec3 reflected;  // the ray's mirror direction
};

// The steps of combine(), for those who have the colours at hand one after the other.
//
// Adds one point of a light: `toward` it, `light` what arrives from it.
Color addLight(Color sum, const Surface& surface, const Facing& facing, Vec3 toward, Color light);
// What is left of a colour at the origin of the ray that brings it.
Color broughtBack(Color sum, Vec3 origin, Vec3 direction, double distance, double extinct, bool inAir,
                  const Setting& setting);

// `samples`: Secondary::samples, if they are still at hand; else the lights are looked at again, with the same answers.
Color combine(const Intersection& hit, const Gathered& gathered, const Setting& setting,
              const LightSamples& samples = {});

// The colour of a ray that meets nothing.
Color missed(const Ray& ray, const Setting& setting);

template <class Archive>
void serialize(Archive& archive, Intersection& i) {
  Surface& surface = i.surface;
  archive(i.position, i.direction, i.normal, i.key, i.lit);
  serializeSparse(archive, Usual{i.origin, Vec3{}}, Usual{i.distance, 0.0}, Usual{i.sample, 0},
                  Usual{i.extinct, 1.0}, Usual{i.inAir, true}, Usual{i.geometricNormal, Vec3{}},
                  Usual{i.smooth, false}, Usual{i.transmitted, false}, Usual{i.reflected, false},
                  Usual{i.transmitWeight, kBlack}, Usual{i.reflectWeight, kBlack});
  serializeSparse(archive, Usual{surface.ambient, kBlack}, Usual{surface.diffuse, kBlack},
                  Usual{surface.specular, kBlack}, Usual{surface.specularPower, 15.0},
                  Usual{surface.body, kWhite}, Usual{surface.translucent, kBlack},
                  Usual{surface.translucency, 0.0}, Usual{surface.translucentPower, 15.0});
}

}  // namespace rayshade
