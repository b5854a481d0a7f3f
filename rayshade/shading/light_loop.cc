// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shading/light_loop.h"

#include "rayshade/optics/refraction.h"

namespace rayshade {

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
