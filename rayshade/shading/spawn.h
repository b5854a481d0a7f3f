// SurfacePoint -> the rays that are sent on from it, with what each will weigh.
//
// All decisions fall here - which lights are asked, what is refracted and what totally reflected, what weighs too
// little - so that an intersection's record is final when it is written and its colours can come in any order.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "rayshade/base/inline_vector.h"
#include "rayshade/optics/ray.h"
#include "rayshade/scene/settings.h"
#include "rayshade/scene/store.h"
#include "rayshade/shading/surface_point.h"

namespace rayshade {

// What is known of one point of a light at a hit.
enum class LightVisibility : std::uint8_t {
  none,        // can't change the colour: it is behind, or the surface does not answer it
  unshadowed,  // casts no shadow here
  traced,      // a shadow ray is on its way
};

// The points of all lights in one row, lights in the order of the file.
using LightVisibilities = InlineVector<LightVisibility, 8>;
using LightSamples = InlineVector<LightSample, 4>;

// A shadow ray: from a hit to a point of a light.
struct ShadowRay {
  Ray ray;
  double distance = 0;       // things at this distance or farther do not matter          [world units]
  Color through = kWhite;    // what has been let through so far
  double last = 0;           // t of the last transparent surface that was crossed
  double insideExtinct = 1;  // extinct of the solid it is in, if `inside`
  bool inside = false;
  std::uint32_t tests = 0;           // objects that were tested; not sent
  ObjectIndex occluder = kNone;      // what to try first, see occlusion(); not sent
  std::uint32_t occluderGround = 0;  // where several models are at hand: which one it belongs to; not sent
};

// The rays that go on from a hit, and what the colours that they bring will weigh.
struct OnwardRays {
  std::optional<Ray> transmitted, reflected;
  Color transmitWeight, reflectWeight;
};

struct Secondary : OnwardRays {
  LightVisibilities lit;
  LightSamples samples;  // what each point of a light looks like from here
};

std::size_t lightPointCount(const SceneSettings& settings);

// What a point of a light, seen as `sample` from the hit, means to it.
LightVisibility lit(const LightSource& light, const LightSample& sample, const SurfacePoint& at,
                    const SceneSettings& settings);

OnwardRays spawnOnward(const Ray& ray, const SurfacePoint& at, const SceneSettings& settings);

// Both, for all points of all lights.
Secondary spawnSecondary(const Ray& ray, const SurfacePoint& at, const SceneSettings& settings);

// The shadow ray to light point `point` (a position in Secondary::lit whose state is `asked`).
ShadowRay shadowRay(const Ray& ray, const SurfacePoint& at, const SceneSettings& settings, std::size_t point);
// The same when the light has been looked at already.
ShadowRay shadowRay(const Ray& ray, const SurfacePoint& at, const LightSample& sample);

// Which light, and which of its points, a position in the row means.
struct LightPoint {
  std::uint32_t light = 0;
  int index = 0;
};
LightPoint lightPoint(const SceneSettings& settings, std::size_t point);

// What a light is asked for at a hit: the same question in spawn and in combine.
LightQuery lightQuery(Vec3 position, RandomKey key, int sample, std::uint32_t light,
                      const SceneSettings& settings);

// The cosine that decides on which side of the surface a light is: that of the shading normal, unless that one is
// interpolated and says "behind" while the surface itself says "in front".
inline double lightCosine(Vec3 toward, Vec3 normal, Vec3 geometricNormal, bool smooth) {
  const double c = dot(toward, normal);
  if (c > 0 || !smooth) return c;
  const double g = dot(toward, geometricNormal);
  return g > 0 ? g : c;
}

template <class Archive>
void serialize(Archive& archive, ShadowRay& s) {
  archive(s.ray);
  serializeSparse(archive, Usual{s.distance, kInfinity}, Usual{s.through, kWhite}, Usual{s.last, 0.0},
                  Usual{s.insideExtinct, 1.0}, Usual{s.inside, false});
}

}  // namespace rayshade
