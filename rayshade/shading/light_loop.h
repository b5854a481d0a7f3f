// The loop over the points of all lights, once, and what a point of a light adds to a colour.
//
// Whoever adds light - `rayshade` and tracing tasks for bundles of hits, shade tasks for one intersection - goes through the
// points in this order, so that the sums have the same bits.  Source of the shading model: Phong 1975 without normalisation,
// as the language has it (docs/language.md).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/inline_vector.h"
#include "rayshade/scene/settings.h"
#include "rayshade/shading/surface_point.h"

namespace rayshade {

// What is known of one point of a light at a hit.
enum class LightVisibility : std::uint8_t {
  none,        // can't change the colour: it is behind, or the surface does not answer it
  unshadowed,  // casts no shadow here
  traced,      // a shadow ray tells
};

// The points of all lights in one row, lights in the order of the file.
using LightVisibilities = InlineVector<LightVisibility, 8>;

struct LightPoint {
  std::uint32_t light = 0;  // in the order of the file
  int index = 0;            // among the points of the light
  std::size_t row = 0;      // in the row of all points
};

std::size_t lightPointCount(const SceneSettings& settings);

// The light of a position in the row, which must be smaller than their number.
const LightSource& lightOfRow(const SceneSettings& settings, std::size_t row);

// Calls use(LightPoint) for each point: lights from the last of the file to the first, the points of a light in their order.
// docs/language.md: a translucent surface scales what has been added before, so the order shows.
template <class Use>
void forEachLightPoint(const SceneSettings& settings, Use&& use) {
  std::size_t end = lightPointCount(settings);
  for (std::size_t l = settings.lights.size(); l-- > 0;) {
    const int points = pointsOf(settings.lights[l]);
    const std::size_t begin = end - static_cast<std::size_t>(points);
    for (int i = 0; i < points; ++i)
      use(LightPoint{static_cast<std::uint32_t>(l), i, begin + static_cast<std::size_t>(i)});
    end = begin;
  }
}

// What a light is asked for at a hit at `position` (world) of a ray with this key and sample number.
inline LightQuery lightQuery(Vec3 position, RandomKey key, int sample, std::uint32_t light,
                             const SceneSettings& settings) {
  return {position, child(key, Branch::light, light), sample, settings.samples};
}

// How a hit is turned towards lights and viewer.  World space.
struct Facing {
  Vec3 normal, geometricNormal;
  bool smooth = false;  // the normal is interpolated: then the geometric one counts too
  Vec3 reflected;       // the ray's mirror direction
};

// The cosine that decides on which side of the surface a light is: that of the shading normal, unless that one is interpolated and
// says "behind" while the surface itself says "in front".
inline double lightCosine(Vec3 toward, Vec3 normal, Vec3 geometricNormal, bool smooth) {
  const double c = dot(toward, normal);
  if (c > 0 || !smooth) return c;
  const double g = dot(toward, geometricNormal);
  return g > 0 ? g : c;
}

// Could light from this side change the colour?
inline bool answersLight(const Surface& surface, double cosine) {
  if (cosine > 0)
    return surface.diffuse != kBlack || surface.specular != kBlack;  // textures may take light away
  return surface.translucency >= kNegligible;
}

// What a point of a light, seen as `sample` from the hit, means to it.
inline LightVisibility visibilityOf(const LightSource& light, const LightSample& sample,
                                    const SurfacePoint& at, const SceneSettings& settings) {
  const double cosine = lightCosine(sample.toward, at.normal, at.geometricNormal, at.smooth);
  if (!(sample.factor > 0) || !answersLight(at.surface, cosine)) return LightVisibility::none;
  return settings.shadows && light.castsShadows && !at.surface.noShadow ? LightVisibility::traced
                                                                        : LightVisibility::unshadowed;
}

// Adds one point of a light: `toward` it, `light` what arrives from it.
Color addLight(Color sum, const Surface& surface, const Facing& facing, Vec3 toward, Color light);

}  // namespace rayshade
