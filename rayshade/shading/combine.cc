// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shading/combine.h"

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

// `sampleOf(light, ofLight, point)`: the point of that number of a light, and in the row of all points.
template <class SampleOf>
Color addLights(const Surface& surface, const Facing& facing, const LightVisibilities& lit,
                const Gathered& gathered, const SceneSettings& settings, SampleOf sampleOf) {
  Color sum = surface.ambient * settings.ambient;
  std::size_t end = lit.size();  // of the points of the light that is being added
  for (std::size_t l = settings.lights.size(); l-- > 0;) {
    const LightSource& light = settings.lights[l];
    const std::size_t begin = end - static_cast<std::size_t>(pointsOf(light));
    for (std::size_t p = begin; p < end; ++p) {
      if (lit[p] == LightVisibility::none) continue;
      const Color through = lit[p] == LightVisibility::traced ? gathered.light[p] : kWhite;
      if (through == kBlack) continue;
      const LightSample& sample = sampleOf(static_cast<std::uint32_t>(l), p - begin, p);
      sum = addLight(sum, surface, facing, sample.toward, sample.factor * (light.color * through));
    }
    end = begin;
  }
  return sum;
}

}  // namespace

// The shading model of the language reference: Phong 1975 without normalisation.
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
  return surface.translucency * sum;
}

Color attenuated(Color sum, Vec3 origin, Vec3 direction, double distance, double extinct, bool inAir,
                 const SceneSettings& settings) {
  if (extinct != 1) sum = std::pow(extinct, distance) * sum;
  if (inAir && !settings.atmosphere.empty()) sum = throughAir(sum, origin, direction, distance, settings);
  return sum;
}

ReturnPath returnPath(const Ray& ray, double t, const OnwardRays& onward, const SceneSettings& settings) {
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

Intersection describe(const Ray& ray, double t, const SurfacePoint& at, const Secondary& spawned,
                      const SceneSettings& settings) {
  Intersection hit;
  hit.back = returnPath(ray, t, spawned, settings);
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
  hit.lit = spawned.lit;
  return hit;
}

Color addLights(const Ray& ray, const SurfacePoint& at, const Secondary& spawned, const Gathered& gathered,
                const SceneSettings& settings) {
  const Facing facing{at.normal, at.geometricNormal, at.smooth, mirrored(ray.direction, at.normal)};
  return addLights(at.surface, facing, spawned.lit, gathered, settings,
                   [&](std::uint32_t, std::size_t, std::size_t point) -> const LightSample& {
                     return spawned.samples[point];
                   });
}

Color finish(Color sum, const ReturnPath& back, Color transmitted, Color reflected,
             const SceneSettings& settings) {
  if (back.transmitted) sum = sum + back.transmitWeight * transmitted;
  if (back.reflected) sum = sum + back.reflectWeight * reflected;
  return attenuated(sum, back.origin, back.direction, back.distance, back.extinct, back.inAir, settings);
}

Color combine(const Intersection& hit, const Gathered& gathered, const SceneSettings& settings) {
  if (hit.lightsAdded)
    return finish(*hit.lightsAdded, hit.back, gathered.transmitted, gathered.reflected, settings);
  const Facing facing{hit.normal, hit.geometricNormal, hit.smooth, mirrored(hit.direction, hit.normal)};
  // The lights are looked at again, with the same answers.
  const Color sum =
      addLights(hit.surface, facing, hit.lit, gathered, settings,
                [&](std::uint32_t light, std::size_t ofLight, std::size_t) {
                  return sampleLight(settings.lights[light],
                                     lightQuery(hit.position, hit.key, hit.sample, light, settings),
                                     static_cast<int>(ofLight));
                });
  return finish(sum, hit.back, gathered.transmitted, gathered.reflected, settings);
}

Color missed(const Ray& ray, const SceneSettings& settings) {
  return attenuated(settings.background, ray.origin, ray.direction, kFarAway, ray.extinct, ray.media.empty(),
                    settings);
}

}  // namespace rayshade
