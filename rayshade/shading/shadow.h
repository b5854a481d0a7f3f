// Shadow rays: from a hit to a point of a light, and what transparent surfaces do to them.
//
// Transparent surfaces filter the light at every crossing, entry and exit, near to far; between an entry and the next crossing
// the light is attenuated by the solid's extinct^distance.  A surface counts as transparent by its own transparency before
// textures; the filter is that after textures (rayshade's rule).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/intersect/model.h"
#include "rayshade/scene/settings.h"
#include "rayshade/shading/surface_point.h"

namespace rayshade {

struct ShadowRay {
  Ray ray;
  double distance = 0;       // things at this distance or farther do not matter          [world units]
  Color through = kWhite;    // what has been let through so far
  double last = 0;           // t of the last transparent surface that was crossed
  double insideExtinct = 1;  // extinct of the solid it is in, if `inside`
  bool inside = false;
};

// From a hit to a point of a light: off the surface.
struct ShadowLine {
  Vec3 origin, direction;  // unit
  double distance = 0;
};
inline ShadowLine shadowLine(const SurfacePoint& at, const LightSample& sample) {
  ShadowLine line{originOff(at, sample.shadowToward), sample.shadowToward, sample.shadowDistance};
  // Where the step off the surface is more than the roundings of any coordinate are, the light is aimed at anew.
  if (at.error > 2 * kRounding * maxAbs(at.position) && line.distance < kInfinity) {
    const Vec3 way = at.position + line.distance * line.direction - line.origin;
    line.direction = normalize(way);
    line.distance = length(way);
  }
  return line;
}

// The shadow ray of a hit to a point of a light that is seen as `sample` from there.
ShadowRay shadowRay(const Ray& ray, const SurfacePoint& at, const LightSample& sample);

// Takes the ray through a transparent surface that it meets.  False: it ends in darkness.
bool passSurface(const Model& model, const Hit& hit, ShadowRay& shadow, const SceneSettings& settings);

}  // namespace rayshade
