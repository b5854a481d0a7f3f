// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shading/shadow.h"

#include "rayshade/shading/evaluate.h"

namespace rayshade {

bool passShadow(const Model& model, const Region& region, ShadowRay& shadow, double tExit,
                const SceneSettings& settings) {
  const double end = std::min(tExit, shadow.distance);
  const Occlusion met = occlusion(model, region, shadow.ray, shadow.last, end, shadow.occluder);
  shadow.tests += met.tests;
  if (met.opaque) return false;
  if (!met.transparent) return true;
  if (!settings.transparentShadows) return false;
  for (;;) {
    const Hit hit = nearestHit(model, region, shadow.ray, shadow.last, end);
    shadow.tests += hit.tests;
    if (!hit.found()) return true;
    if (!passSurface(model, hit, shadow, settings)) return false;
  }
}

bool passSurface(const Model& model, const Hit& hit, ShadowRay& shadow, const SceneSettings& settings) {
  const HitPath path = pathTo(model, shadow.ray, hit);
  if (boundSurface(model, path).transparency < kNegligible) return false;
  const SurfacePoint at = evaluateSurface(model, hit, path, shadow.ray, settings);
  if (shadow.inside) shadow.through = shadow.through * std::pow(shadow.insideExtinct, hit.t - shadow.last);
  shadow.through = shadow.through * (at.surface.transparency * at.surface.body);
  if (!anyAbove(shadow.through, kNegligible)) return false;
  shadow.inside = at.entering;
  shadow.insideExtinct = at.surface.extinct;
  shadow.last = hit.t;
  return true;
}

}  // namespace rayshade
