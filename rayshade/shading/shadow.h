// What one region does to a shadow ray.
//
// An opaque thing anywhere on the way means darkness, whatever else is there.  Transparent ones filter the light at
// every crossing, entry and exit, near to far; between an entry and the next crossing the light is attenuated by the
// solid's extinct^distance.  A surface counts as transparent by its own transparency before textures; the filter is
// that after textures (rayshade's rule).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/intersect/model.h"
#include "rayshade/scene/settings.h"
#include "rayshade/shading/spawn.h"

namespace rayshade {

// Takes the ray through a region, up to tExit or its light.  False: it ends in darkness.
bool passShadow(const Model& model, const Region& region, ShadowRay& shadow, double tExit,
                const SceneSettings& settings);

// Takes the ray through a transparent surface that it meets.  False: it ends in darkness.
bool passSurface(const Model& model, const Hit& hit, ShadowRay& shadow, const SceneSettings& settings);

}  // namespace rayshade
