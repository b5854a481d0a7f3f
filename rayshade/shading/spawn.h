// SurfacePoint -> the rays that are sent on from it, with what each will weigh.
//
// All decisions fall here - what is refracted and what totally reflected, what weighs too little - so that an intersection's
// record is final when it is written and its colours can come in any order.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "rayshade/optics/ray.h"
#include "rayshade/scene/settings.h"
#include "rayshade/shading/surface_point.h"

namespace rayshade {

// The rays that go on from a hit, and what the colours that they bring will weigh.
struct OnwardRays {
  std::optional<Ray> transmitted, reflected;
  Color transmitWeight, reflectWeight;
};

// All of `spawned` is filled in; it is large, and so is made where it stays.
void spawnOnward(const Ray& ray, const SurfacePoint& at, const SceneSettings& settings, OnwardRays& spawned);

}  // namespace rayshade
