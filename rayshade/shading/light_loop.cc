// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shading/light_loop.h"

#include "rayshade/optics/refraction.h"

namespace rayshade {
namespace {

// Could light from this side change the colour?
bool answers(const Surface& surface, double cosine) {
  if (cosine > 0)
    return surface.diffuse != kBlack || surface.specular != kBlack;  // textures may take light away
  return surface.translucency >= kNegligible;
}

}  // namespace

std::size_t lightPointCount(const SceneSettings& settings) {
  std::size_t count = 0;
  for (const LightSource& light : settings.lights) count += static_cast<std::size_t>(pointsOf(light));
  return count;
}

const LightSource& lightOfRow(const SceneSettings& settings, std::size_t row) {
  std::size_t light = 0;
  for (; light + 1 < settings.lights.size(); ++light) {
    const auto points = static_cast<std::size_t>(pointsOf(settings.lights[light]));
    if (row < points) break;
    row -= points;
  }
  return settings.lights[light];
}

LightQuery lightQuery(Vec3 position, RandomKey key, int sample, std::uint32_t light,
                      const SceneSettings& settings) {
  return {position, child(key, Branch::light, light), sample, settings.samples};
}

double lightCosine(Vec3 toward, Vec3 normal, Vec3 geometricNormal, bool smooth) {
  const double c = dot(toward, normal);
  if (c > 0 || !smooth) return c;
  const double g = dot(toward, geometricNormal);
  return g > 0 ? g : c;
}

LightVisibility visibilityOf(const LightSource& light, const LightSample& sample, const SurfacePoint& at,
                             const SceneSettings& settings) {
  const double cosine = lightCosine(sample.toward, at.normal, at.geometricNormal, at.smooth);
  if (!(sample.factor > 0) || !answers(at.surface, cosine)) return LightVisibility::none;
  return settings.shadows && light.castsShadows && !at.surface.noShadow ? LightVisibility::traced
                                                                        : LightVisibility::unshadowed;
}

Color addLight(Color sum, const Surface& surface, const Facing& facing, Vec3 toward, Color light) {
  const double along = dot(facing.reflected, toward);
  const double cosine = lightCosine(toward, facing.normal, facing.geometricNormal, facing.smooth);
  if (cosine > 0) {
    sum = sum + cosine * (surface.diffuse * light);
    if (surface.specular == kBlack) return sum;  // spares a pow
    const double lobe = phongLobe(along, surface.specularPower);
    return lobe > 0 ? sum + lobe * (surface.specular * light) : sum;
  }
  sum = sum + -cosine * (surface.translucent * light);
  const double lobe = phongLobe(-along, surface.translucentPower);
  if (lobe > 0) sum = sum + lobe * (surface.body * light);
  // Everything summed so far is scaled, ambient and earlier lights included: what rayshade does.
  return limited(surface.translucency * sum);
}

}  // namespace rayshade
