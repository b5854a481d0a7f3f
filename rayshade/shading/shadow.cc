// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shading/shadow.h"

#include "rayshade/base/elementary.h"
#include "rayshade/shading/evaluate.h"

namespace rayshade {

// `from`: where the direction and the distance were measured.
void aimAnew(ShadowLine& line, Vec3 from) {
  const Vec3 way = from + line.distance * line.direction - line.origin;
  line.direction = normalize(way);
  line.distance = length(way);
}

ShadowRay shadowRay(const Ray& ray, const SurfacePoint& at, const LightSample& sample) {
  ShadowRay shadow;
  const ShadowLine line = shadowLine(at, sample);
  shadow.ray.origin = line.origin;
  shadow.ray.direction = line.direction;
  shadow.ray.moment = ray.moment;
  shadow.ray.sample = ray.sample;
  shadow.ray.key = ray.key;
  shadow.distance = line.distance;
  return shadow;
}

bool passSurface(const Model& model, const Hit& hit, ShadowRay& shadow, const SceneSettings& settings) {
  const HitPath path = pathTo(model, shadow.ray, hit);
  if (boundSurface(model, path).transparency < kNegligible) return false;
  SurfacePoint at;
  evaluateSurface(model, hit, path, shadow.ray, settings, at);
  if (shadow.inside)
    shadow.through = shadow.through * elementary::pow(shadow.insideExtinct, hit.t - shadow.last);
  shadow.through = limited(shadow.through * (at.surface.transparency * at.surface.body));
  if (!anyAbove(shadow.through, kNegligible)) return false;
  shadow.inside = at.entering;
  shadow.insideExtinct = at.surface.extinct;
  shadow.last = hit.t;
  return true;
}

}  // namespace rayshade
