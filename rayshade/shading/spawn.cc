// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shading/spawn.h"

#include "rayshade/optics/refraction.h"

namespace rayshade {
namespace {

// Could light from this side change the colour?
bool answers(const Surface& surface, double cosine) {
  if (cosine > 0) return anyAbove(surface.diffuse, 0) || anyAbove(surface.specular, 0);
  return surface.translucency >= kNegligible;
}

// A child of a ray, leaving the hit in a direction.
Ray secondaryRay(const Ray& ray, const SurfacePoint& at, Vec3 direction, Branch branch, Color weight) {
  Ray child;
  child.origin = originOff(at, direction);
  child.direction = direction;
  child.moment = ray.moment;
  child.depth = ray.depth + 1;
  child.sample = ray.sample;
  child.key = rayshade::child(ray.key, branch);
  child.contribution = ray.contribution * weight;
  return child;
}

// The media before and behind the surface.  Leaving, the index of the hit surface itself counts as the inner one
// (rayshade's rule, whatever the stack says).
struct Passage {
  double n1, n2;
  MediumStack behind;
};
Passage passage(const Ray& ray, const SurfacePoint& at, const Setting& setting) {
  auto top = [&](const MediumStack& stack) { return stack.empty() ? setting.airIndex : stack.back().index; };
  Passage p{top(ray.media), at.surface.index, ray.media};
  if (at.entering) {
    p.behind.push_back({at.surface.index, at.surface.extinct});
  } else {
    p.n1 = at.surface.index;
    if (!p.behind.empty()) p.behind.pop_back();
    p.n2 = top(p.behind);
  }
  return p;
}

}  // namespace

std::size_t lightPointCount(const Setting& setting) {
  std::size_t count = 0;
  for (const LightSource& light : setting.lights) count += static_cast<std::size_t>(pointsOf(light));
  return count;
}

LightPoint lightPoint(const Setting& setting, std::size_t point) {
  std::uint32_t light = 0;
  for (; light + 1 < setting.lights.size(); ++light) {
    const auto points = static_cast<std::size_t>(pointsOf(setting.lights[light]));
    if (point < points) break;
    point -= points;
  }
  return {light, static_cast<int>(point)};
}

LightQuery lightQuery(Vec3 position, RandomKey key, int sample, std::uint32_t light, const Setting& setting) {
  return {position, child(key, Branch::light, light), sample, setting.samplesPerSide};
}

Lit lit(const LightSource& light, const LightSample& sample, const SurfacePoint& at, const Setting& setting) {
  const double cosine = lightCosine(sample.toward, at.normal, at.geometricNormal, at.smooth);
  if (!(sample.factor > 0) || !answers(at.surface, cosine)) return Lit::no;
  return setting.shadows && light.castsShadows && !at.surface.noShadow ? Lit::asked : Lit::fully;
}

Secondary spawnSecondary(const Ray& ray, const SurfacePoint& at, const Setting& setting) {
  Secondary spawned{spawnOnward(ray, at, setting), {}, {}};
  for (std::uint32_t l = 0; l < setting.lights.size(); ++l) {
    const LightSource& light = setting.lights[l];
    const LightQuery query = lightQuery(at.position, ray.key, ray.sample, l, setting);
    const int points = pointsOf(light);
    for (int i = 0; i < points; ++i) {
      const LightSample sample = sampleLight(light, query, i);
      spawned.samples.push_back(sample);
      spawned.lit.push_back(lit(light, sample, at, setting));
    }
  }
  return spawned;
}

OnwardRays spawnOnward(const Ray& ray, const SurfacePoint& at, const Setting& setting) {
  const Surface& surface = at.surface;
  OnwardRays spawned;
  if (ray.depth >= setting.limits.maxDepth) return spawned;

  Color reflectWeight = surface.reflect * surface.specular;
  if (surface.transparency > kNegligible) {
    const Color weight = surface.transparency * surface.body;
    if (anyAbove(weight * ray.contribution, setting.limits.cutoff)) {
      Passage through = passage(ray, at, setting);
      if (const auto direction = refracted(ray.direction, at.normal, through.n1, through.n2)) {
        spawned.transmitWeight = weight;
        spawned.transmitted = secondaryRay(ray, at, *direction, Branch::transmitted, weight);
        if (!through.behind.empty()) spawned.transmitted->extinct = through.behind.back().extinct;
        spawned.transmitted->media = std::move(through.behind);
      } else {
        reflectWeight = reflectWeight + weight;  // total reflection
      }
    }
  }
  if (anyAbove(reflectWeight, kNegligible) &&
      anyAbove(reflectWeight * ray.contribution, setting.limits.cutoff)) {
    spawned.reflectWeight = reflectWeight;
    spawned.reflected = secondaryRay(ray, at, normalize(mirrored(ray.direction, at.normal)),
                                     Branch::reflected, reflectWeight);
    spawned.reflected->media = ray.media;
  }
  return spawned;
}

ShadowRay shadowRay(const Ray& ray, const SurfacePoint& at, const Setting& setting, std::size_t point) {
  const LightPoint which = lightPoint(setting, point);
  const LightSource& light = setting.lights[which.light];
  return shadowRay(
      ray, at,
      sampleLight(light, lightQuery(at.position, ray.key, ray.sample, which.light, setting), which.index));
}

ShadowRay shadowRay(const Ray& ray, const SurfacePoint& at, const LightSample& sample) {
  ShadowRay shadow;
  shadow.ray.origin = originOff(at, sample.shadowToward);
  shadow.ray.direction = sample.shadowToward;
  shadow.ray.moment = ray.moment;
  shadow.ray.sample = ray.sample;
  shadow.ray.key = ray.key;
  shadow.distance = sample.shadowDistance;
  return shadow;
}

}  // namespace rayshade
