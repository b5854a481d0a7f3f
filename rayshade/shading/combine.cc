// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shading/combine.h"

#include "rayshade/optics/refraction.h"

namespace rayshade {
namespace {

Color throughAir(Color seen, Vec3 origin, Vec3 direction, double distance, const Setting& setting) {
  const AirPath path{origin, origin + distance * direction, distance};
  // The last effect of the file is applied first (rayshade's order).
  for (std::size_t i = setting.atmosphere.size(); i-- > 0;)
    seen = std::visit([&](const auto& effect) { return effect.apply(seen, path); }, setting.atmosphere[i]);
  return seen;
}

// `sampleOf(light, ofLight, point)`: the point of that number of a light, and in the row of all points.
template <class SampleOf>
Color addLights(const Surface& surface, const Facing& facing, const LightStates& lit,
                const Gathered& gathered, const Setting& setting, SampleOf sampleOf) {
  Color sum = surface.ambient * setting.ambient;
  std::size_t end = lit.size();  // of the points of the light that is being added
  for (std::size_t l = setting.lights.size(); l-- > 0;) {
    const LightSource& light = setting.lights[l];
    const std::size_t begin = end - static_cast<std::size_t>(pointsOf(light));
    for (std::size_t p = begin; p < end; ++p) {
      if (lit[p] == Lit::no) continue;
      const Color through = lit[p] == Lit::asked ? gathered.light[p] : kWhite;
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

Color broughtBack(Color sum, Vec3 origin, Vec3 direction, double distance, double extinct, bool inAir,
                  const Setting& setting) {
  if (extinct != 1) sum = std::pow(extinct, distance) * sum;
  if (inAir && !setting.atmosphere.empty()) sum = throughAir(sum, origin, direction, distance, setting);
  return sum;
}

WayBack wayBack(const Ray& ray, double t, const OnwardRays& onward, const Setting& setting) {
  WayBack back;
  back.extinct = ray.extinct;
  back.inAir = ray.media.empty();
  const bool throughAtmosphere = back.inAir && !setting.atmosphere.empty();
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
                      const Setting& setting) {
  Intersection hit;
  hit.back = wayBack(ray, t, spawned, setting);
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
                const Setting& setting) {
  const Facing facing{at.normal, at.geometricNormal, at.smooth, mirrored(ray.direction, at.normal)};
  return addLights(at.surface, facing, spawned.lit, gathered, setting,
                   [&](std::uint32_t, std::size_t, std::size_t point) -> const LightSample& {
                     return spawned.samples[point];
                   });
}

Color finish(Color sum, const WayBack& back, Color transmitted, Color reflected, const Setting& setting) {
  if (back.transmitted) sum = sum + back.transmitWeight * transmitted;
  if (back.reflected) sum = sum + back.reflectWeight * reflected;
  return broughtBack(sum, back.origin, back.direction, back.distance, back.extinct, back.inAir, setting);
}

Color combine(const Intersection& hit, const Gathered& gathered, const Setting& setting) {
  if (hit.lightsAdded)
    return finish(*hit.lightsAdded, hit.back, gathered.transmitted, gathered.reflected, setting);
  const Facing facing{hit.normal, hit.geometricNormal, hit.smooth, mirrored(hit.direction, hit.normal)};
  // The lights are looked at again, with the same answers.
  const Color sum =
      addLights(hit.surface, facing, hit.lit, gathered, setting,
                [&](std::uint32_t light, std::size_t ofLight, std::size_t) {
                  return sampleLight(setting.lights[light],
                                     lightQuery(hit.position, hit.key, hit.sample, light, setting),
                                     static_cast<int>(ofLight));
                });
  return finish(sum, hit.back, gathered.transmitted, gathered.reflected, setting);
}

Color missed(const Ray& ray, const Setting& setting) {
  return broughtBack(setting.background, ray.origin, ray.direction, kFarAway, ray.extinct, ray.media.empty(),
                     setting);
}

}  // namespace rayshade
