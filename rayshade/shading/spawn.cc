// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shading/spawn.h"

#include "rayshade/optics/refraction.h"

namespace rayshade {
namespace {

// Makes a child of a ray, leaving the hit in a direction.
void secondaryRay(const Ray& ray, const SurfacePoint& at, Vec3 direction, Branch branch, Color weight,
                  Ray& child) {
  child.origin = originOff(at, direction);
  child.direction = direction;
  child.moment = ray.moment;
  child.depth = ray.depth + 1;
  child.sample = ray.sample;
  child.key = rayshade::child(ray.key, branch);
  child.contribution = ray.contribution * weight;
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

void spawnOnward(const Ray& ray, const SurfacePoint& at, const SceneSettings& settings, OnwardRays& spawned) {
  const Surface& surface = at.surface;
  spawned.transmitted.reset();
  spawned.reflected.reset();
  spawned.transmitWeight = spawned.reflectWeight = kBlack;
  if (ray.depth >= settings.limits.maxDepth) return;

  Color reflectWeight = surface.reflect * surface.specular;
  if (surface.transparency > kNegligible) {
    const Color weight = surface.transparency * surface.body;
    if (anyAbove(weight * ray.contribution, settings.limits.cutoff)) {
      Passage through = passage(ray, at, settings);
      if (const auto direction = refracted(ray.direction, at.normal, through.n1, through.n2)) {
        spawned.transmitWeight = weight;
        Ray& child = spawned.transmitted.emplace();
        secondaryRay(ray, at, *direction, Branch::transmitted, weight, child);
        if (!through.behind.empty()) child.extinct = through.behind.back().extinct;
        child.media = std::move(through.behind);
      } else {
        reflectWeight = reflectWeight + weight;  // total reflection
      }
    }
  }
  if (anyAbove(reflectWeight, kNegligible) &&
      anyAbove(reflectWeight * ray.contribution, settings.limits.cutoff)) {
    spawned.reflectWeight = reflectWeight;
    Ray& child = spawned.reflected.emplace();
    secondaryRay(ray, at, normalize(mirrored(ray.direction, at.normal)), Branch::reflected, reflectWeight,
                 child);
    child.media = ray.media;
  }
}

}  // namespace rayshade
