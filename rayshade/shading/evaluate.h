// Hit -> SurfacePoint: where it is, which way it faces, what it is made of.  The first of the four steps that needs
// object data, and the last: what comes after works on values alone.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/intersect/model.h"
#include "rayshade/scene/settings.h"
#include "rayshade/shading/surface_point.h"

namespace rayshade {

// Requires hit.found().  All of `at` is filled in; it is large, and so is made where it stays.
void evaluateSurface(const Model& model, const Hit& hit, const Ray& ray, const SceneSettings& settings,
                     SurfacePoint& at);
// The same when pathTo() has been asked already.
void evaluateSurface(const Model& model, const Hit& hit, const HitPath& path, const Ray& ray,
                     const SceneSettings& settings, SurfacePoint& at);

// The surface that binds a hit, before textures: the innermost of the path from the shape up to the world.
const Surface& boundSurface(const Model& model, const HitPath& path);

}  // namespace rayshade
