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

Intersection describe(const Ray& ray, double t, const SurfacePoint& at, const Secondary& spawned,
                      const Setting& setting) {
  Intersection hit;
  hit.direction = ray.direction;
  hit.key = ray.key;
  hit.sample = ray.sample;
  hit.extinct = ray.extinct;
  hit.inAir = ray.media.empty();
  const bool throughAtmosphere = hit.inAir && !setting.atmosphere.empty();
  if (throughAtmosphere) hit.origin = ray.origin;
  if (throughAtmosphere || hit.extinct != 1) hit.distance = t;
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
  hit.transmitted = spawned.transmitted.has_value();
  hit.reflected = spawned.reflected.has_value();
  hit.transmitWeight = spawned.transmitWeight;
  hit.reflectWeight = spawned.reflectWeight;
  return hit;
}

Color combine(const Intersection& hit, const Gathered& gathered, const Setting& setting,
              const LightSamples& samples) {
  const Facing facing{hit.normal, hit.geometricNormal, hit.smooth, mirrored(hit.direction, hit.normal)};
  Color sum = hit.surface.ambient * setting.ambient;
  std::size_t end = hit.lit.size();  // of the points of the light that is being added
  for (std::size_t l = setting.lights.size(); l-- > 0;) {
    const LightSource& light = setting.lights[l];
    const auto points = static_cast<std::size_t>(pointsOf(light));
    const std::size_t begin = end - points;
    const LightQuery query =
        lightQuery(hit.position, hit.key, hit.sample, static_cast<std::uint32_t>(l), setting);
    for (std::size_t p = begin; p < end; ++p) {
      if (hit.lit[p] == Lit::no) continue;
      const Color through = hit.lit[p] == Lit::asked ? gathered.light[p] : kWhite;
      if (through == kBlack) continue;
      const LightSample sample =
          samples.empty() ? sampleLight(light, query, static_cast<int>(p - begin)) : samples[p];
      sum = addLight(sum, hit.surface, facing, sample.toward, sample.factor * (light.color * through));
    }
    end = begin;
  }
  if (hit.transmitted) sum = sum + hit.transmitWeight * gathered.transmitted;
  if (hit.reflected) sum = sum + hit.reflectWeight * gathered.reflected;
  return broughtBack(sum, hit.origin, hit.direction, hit.distance, hit.extinct, hit.inAir, setting);
}

Color missed(const Ray& ray, const Setting& setting) {
  return broughtBack(setting.background, ray.origin, ray.direction, kFarAway, ray.extinct, ray.media.empty(),
                     setting);
}

}  // namespace rayshade
