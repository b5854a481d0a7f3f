// A bundle of hits -> light and onward rays: what is done at a hit, by all programs.
//
// Surfaces are evaluated, every point of every light is asked in the order of the light loop, and the rays that go on are spawned.
// Where all shadow rays can be resolved with what is local, the light is added at once.  A hit one of whose shadow rays goes on
// elsewhere keeps what is known and says what is pending; combine() adds the lights when the last colour has come, to the
// same bits.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "rayshade/shading/combine.h"
#include "rayshade/trace/trace_shadows.h"

namespace rayshade {

// A ray and what it hit.  Both are kept by the caller.
struct RayHit {
  const Ray* ray = nullptr;
  Hit hit;
  const Model* model = nullptr;
};

// A shadow ray that goes on elsewhere.
struct PendingShadow {
  std::size_t row = 0;  // which light point
  ShadowRay shadow;
  NextBlock next;
};

// What is known of the light at a hit.
struct HitLight {
  SurfacePoint point;
  Color sum;  // ambient light and all lights, if they were added and nothing is pending
  // Kept only if that is asked for: by row of light points, what each is to the hit and what of it is let through.
  LightVisibilities visibility;
  InlineVector<Color, 4> light;
  std::vector<PendingShadow> pending;  // in the order of the light loop
};

// What has become of a hit.
struct ShadedHit : HitLight {
  const Ray* ray = nullptr;
  double t = 0;
  Facing facing;
  OnwardRays onward;
};

// What is to be found out.
struct ShadingWork {
  bool sums = true;      // add the lights
  bool records = false;  // keep visibility and light, for those who may have to add them later
};

// Room that is used again from bundle to bundle: for one light point, by hit, and for its shadow rays.
struct ShadingRoom {
  std::array<LightSample, kBundleSize> samples;
  std::array<LightVisibility, kBundleSize> visibility;
  std::array<Color, kBundleSize> through;  // what arrives at each hit
  std::array<Segment, kBundleSize> segments;
  std::array<Color, kBundleSize> arriving;
  std::array<std::size_t, kBundleSize> from;  // which hit asks
  std::vector<OpenShadow> open;
};

// Shades at most kBundleSize hits; shaded[i] is that of hits[i].  With nothing but local blocks nothing is pending.
void shadeHits(LocalSpace& space, std::span<const RayHit> hits, const SceneSettings& settings,
               ShadingWork work, std::span<ShadedHit> shaded, ShadingRoom& room, TraceCounts& counts);

}  // namespace rayshade
