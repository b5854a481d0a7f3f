// Intersection + all its colours -> one colour.
//
// The order is fixed - ambient, lights from the last to the first of the file, transmitted, reflected, attenuation,
// atmosphere - so it does not matter when a colour came.  No object data is needed (Reinhard & Jansen, section 3:
// "shading must be independent of tracing, and hence be independent of object data").
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "rayshade/shading/light_loop.h"
#include "rayshade/shading/spawn.h"

namespace rayshade {

// What becomes of the colour of a hit once its lights have been added: what is added then, and its way back along the ray
// that hit.  What this scene does not ask for stays at its usual value, which costs a bit on the wire.
struct ReturnPath {
  Vec3 origin, direction;  // of the ray, if the atmosphere asks for them
  double distance = 0;     // t of the hit, if atmosphere or attenuation ask for it
  double extinct = 1;      // of what the ray travelled through, if it counts
  bool inAir = true;       // outside of all media: the atmosphere applies
  bool transmitted = false, reflected = false;
  Color transmitWeight, reflectWeight;
};

// All that combine() needs to know of a hit, and nothing else.
struct Intersection {
  ReturnPath back;
  Vec3 direction;  // of the ray that hit
  RandomKey key{};
  std::int32_t sample = 0;
  Vec3 position, normal;
  bool smooth = false;  // the normal is interpolated: then the geometric one counts too
  Vec3 geometricNormal;
  Surface surface;  // what is seen of it: neither its index nor how much it reflects
  LightVisibilities visibility;
};

// The colours that come back, each in its own place.
struct Gathered {
  InlineVector<Color, 4> light;  // by light point; what is let through, for those that were asked
  Color transmitted, reflected;
};

inline ReturnPath returnPath(const Ray& ray, double t, const OnwardRays& onward,
                             const SceneSettings& settings) {
  ReturnPath back;
  back.extinct = ray.extinct;
  back.inAir = ray.media.empty();
  const bool throughAtmosphere = back.inAir && !settings.atmosphere.empty();
  if (throughAtmosphere) {
    back.origin = ray.origin;
    back.direction = ray.direction;
  }
  if (throughAtmosphere || back.extinct != 1) back.distance = t;
  back.transmitted = onward.transmitted.has_value();
  back.reflected = onward.reflected.has_value();
  back.transmitWeight = onward.transmitWeight;
  back.reflectWeight = onward.reflectWeight;
  return back;
}

Intersection describe(const Ray& ray, const ReturnPath& back, const SurfacePoint& at,
                      LightVisibilities visibility);

// What is left of a colour at the origin of the ray that brings it.
Color attenuated(Color sum, Vec3 origin, Vec3 direction, double distance, double extinct, bool inAir,
                 const SceneSettings& settings);

// What comes after the lights.
Color finish(Color sum, const ReturnPath& back, Color transmitted, Color reflected,
             const SceneSettings& settings);

Color combine(const Intersection& hit, const Gathered& gathered, const SceneSettings& settings);

// The colour of a ray that meets nothing.
Color missed(const Ray& ray, const SceneSettings& settings);

template <class Archive>
void serialize(Archive& archive, ReturnPath& b) {
  serializeSparse(archive, Usual{b.origin, Vec3{}}, Usual{b.direction, Vec3{}}, Usual{b.distance, 0.0},
                  Usual{b.extinct, 1.0}, Usual{b.inAir, true}, Usual{b.transmitted, false},
                  Usual{b.reflected, false}, Usual{b.transmitWeight, kBlack}, Usual{b.reflectWeight, kBlack});
}
template <class Archive>
void serialize(Archive& archive, Intersection& i) {
  Surface& surface = i.surface;
  archive(i.back, i.direction, i.key, i.position, i.normal, i.visibility);
  serializeSparse(archive, Usual{i.sample, 0}, Usual{i.geometricNormal, Vec3{}}, Usual{i.smooth, false});
  serializeSparse(archive, Usual{surface.ambient, kBlack}, Usual{surface.diffuse, kBlack},
                  Usual{surface.specular, kBlack}, Usual{surface.specularPower, 15.0},
                  Usual{surface.body, kWhite}, Usual{surface.translucent, kBlack},
                  Usual{surface.translucency, 0.0}, Usual{surface.translucentPower, 15.0});
}

}  // namespace rayshade
