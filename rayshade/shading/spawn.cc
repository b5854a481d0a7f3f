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
Passage passage(const Ray& ray, const SurfacePoint& at, const SceneSettings& settings) {
  auto top = [&](const MediumStack& stack) { return stack.empty() ? settings.airIndex : stack.back().index; };
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

std::size_t lightPointCount(const SceneSettings& settings) {
  std::size_t count = 0;
  for (const LightSource& light : settings.lights) count += static_cast<std::size_t>(pointsOf(light));
  return count;
}

LightPoint lightPoint(const SceneSettings& settings, std::size_t point) {
  std::uint32_t light = 0;
  for (; light + 1 < settings.lights.size(); ++light) {
    const auto points = static_cast<std::size_t>(pointsOf(settings.lights[light]));
    if (point < points) break;
    point -= points;
  }
  return {light, static_cast<int>(point)};
}

LightQuery lightQuery(Vec3 position, RandomKey key, int sample, std::uint32_t light,
                      const SceneSettings& settings) {
  return {position, child(key, Branch::light, light), sample, settings.samplesPerSide};
}

LightVisibility lit(const LightSource& light, const LightSample& sample, const SurfacePoint& at,
                    const SceneSettings& settings) {
  const double cosine = lightCosine(sample.toward, at.normal, at.geometricNormal, at.smooth);
  if (!(sample.factor > 0) || !answers(at.surface, cosine)) return LightVisibility::none;
  return settings.shadows && light.castsShadows && !at.surface.noShadow ? LightVisibility::traced
                                                                        : LightVisibility::unshadowed;
}

Secondary spawnSecondary(const Ray& ray, const SurfacePoint& at, const SceneSettings& settings) {
  Secondary spawned{spawnOnward(ray, at, settings), {}, {}};
  for (std::uint32_t l = 0; l < settings.lights.size(); ++l) {
    const LightSource& light = settings.lights[l];
    const LightQuery query = lightQuery(at.position, ray.key, ray.sample, l, settings);
    const int points = pointsOf(light);
    for (int i = 0; i < points; ++i) {
      const LightSample sample = sampleLight(light, query, i);
      spawned.samples.push_back(sample);
      spawned.lit.push_back(lit(light, sample, at, settings));
    }
  }
  return spawned;
}

OnwardRays spawnOnward(const Ray& ray, const SurfacePoint& at, const SceneSettings& settings) {
  const Surface& surface = at.surface;
  OnwardRays spawned;
  if (ray.depth >= settings.limits.maxDepth) return spawned;

  Color reflectWeight = surface.reflect * surface.specular;
  if (surface.transparency > kNegligible) {
    const Color weight = surface.transparency * surface.body;
    if (anyAbove(weight * ray.contribution, settings.limits.cutoff)) {
      Passage through = passage(ray, at, settings);
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
      anyAbove(reflectWeight * ray.contribution, settings.limits.cutoff)) {
    spawned.reflectWeight = reflectWeight;
    spawned.reflected = secondaryRay(ray, at, normalize(mirrored(ray.direction, at.normal)),
                                     Branch::reflected, reflectWeight);
    spawned.reflected->media = ray.media;
  }
  return spawned;
}

ShadowRay shadowRay(const Ray& ray, const SurfacePoint& at, const SceneSettings& settings,
                    std::size_t point) {
  const LightPoint which = lightPoint(settings, point);
  const LightSource& light = settings.lights[which.light];
  return shadowRay(
      ray, at,
      sampleLight(light, lightQuery(at.position, ray.key, ray.sample, which.light, settings), which.index));
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
