// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shading/combine.h"

#include "rayshade/base/elementary.h"
#include "rayshade/optics/refraction.h"

namespace rayshade {
namespace {

Color throughAir(Color seen, Vec3 origin, Vec3 direction, double distance, const SceneSettings& settings) {
  const AirPath path{origin, origin + distance * direction, distance};
  // The last effect of the file is applied first (rayshade's order).
  for (std::size_t i = settings.atmosphere.size(); i-- > 0;)
    seen = std::visit([&](const auto& effect) { return effect.apply(seen, path); }, settings.atmosphere[i]);
  return seen;
}

}  // namespace

Color attenuated(Color sum, Vec3 origin, Vec3 direction, double distance, double extinct, bool inAir,
                 const SceneSettings& settings) {
  if (extinct != 1) sum = elementary::pow(extinct, distance) * sum;
  if (inAir && !settings.atmosphere.empty()) sum = throughAir(sum, origin, direction, distance, settings);
  return sum;
}

Intersection describe(const Ray& ray, const ReturnPath& back, const SurfacePoint& at,
                      LightVisibilities visibility) {
  Intersection hit;
  hit.back = back;
  hit.direction = ray.direction;
  hit.key = ray.key;
  hit.sample = ray.sample;
  hit.position = at.position;
  hit.normal = at.normal;
  hit.smooth = at.smooth;
  if (at.smooth) hit.geometricNormal = at.geometricNormal;
  hit.surface.ambient = at.surface.ambient;
  hit.surface.diffuse = at.surface.diffuse;
  hit.surface.specular = at.surface.specular;
  hit.surface.specularPower = at.surface.specularPower;
  if (at.surface.translucency >= kNegligible) {
    hit.surface.body = at.surface.body;
    hit.surface.translucent = at.surface.translucent;
    hit.surface.translucency = at.surface.translucency;
    hit.surface.translucentPower = at.surface.translucentPower;
  }
  hit.visibility = std::move(visibility);
  return hit;
}

Color finish(Color sum, const ReturnPath& back, Color transmitted, Color reflected,
             const SceneSettings& settings) {
  if (back.transmitted) sum = sum + back.transmitWeight * transmitted;
  if (back.reflected) sum = sum + back.reflectWeight * reflected;
  sum = attenuated(sum, back.origin, back.direction, back.distance, back.extinct, back.inAir, settings);
  return limited(sum);  // else mirrors that give more than they get would lead to infinity
}

Color combine(const Intersection& hit, const Gathered& gathered, const SceneSettings& settings) {
  const Facing facing{hit.normal, hit.geometricNormal, hit.smooth, mirrored(hit.direction, hit.normal)};
  Color sum = hit.surface.ambient * settings.ambient;
  forEachLightPoint(settings, [&](const LightPoint& point) {
    const LightVisibility visibility = hit.visibility[point.row];
    if (visibility == LightVisibility::none) return;
    const Color through = visibility == LightVisibility::traced ? gathered.light[point.row] : kWhite;
    if (through == kBlack) return;
    // The light is looked at again, with the same answer.
    const LightSource& light = settings.lights[point.light];
    const LightSample sample =
        sampleLight(light, lightQuery(hit.position, hit.key, hit.sample, point.light, settings), point.index);
    sum = addLight(sum, hit.surface, facing, sample.toward, sample.factor * (light.color * through));
  });
  return finish(sum, hit.back, gathered.transmitted, gathered.reflected, settings);
}

Color missed(const Ray& ray, const SceneSettings& settings) {
  return attenuated(settings.background, ray.origin, ray.direction, kFarAway, ray.extinct, ray.media.empty(),
                    settings);
}

}  // namespace rayshade
