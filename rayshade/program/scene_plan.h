// How a picture of a scene would be made, and what of the renderer this scene has no use for.
//
// A pure function of what stands in the file and on the command line: nothing is traced.  A kind of ray that the plan
// rules out is never sent (tests compare with what is counted); what is said to be off is not computed at all.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

#include "rayshade/scene/features.h"
#include "rayshade/scene/settings.h"

namespace rayshade {

struct ScenePlan {
  SceneFeatures features;

  // The picture.
  PixelArea area;
  std::int32_t frames = 1;
  std::int32_t samplesAtLeast = 1, samplesAtMost = 1;   // in a pixel that does not lie on the border
  std::uint64_t eyeRaysAtLeast = 0, eyeRaysAtMost = 0;  // in a frame
  bool jitter = true, gaussian = false;
  bool lens = false;     // the eye's rays start on a lens
  bool moments = false;  // samples of a pixel are taken at different times

  // The rays that may be sent.
  Limits limits;
  bool shadowRays = false, transmittedRays = false, reflectedRays = false;
  std::array<std::uint64_t, AllLights::size> lights{};  // by position in AllLights
  std::uint64_t shadowRaysPerHit = 0;                   // at most
  bool filteredShadows = false;                         // shadow rays that are not simply stopped
  bool attenuation = false;
  std::size_t atmosphericEffects = 0;
};

// `picture` has an area, i.e. has been checked.
ScenePlan scenePlan(const SceneFeatures& features, const SceneHead& head);

// As lines of text, what is used before what is not.
std::string describe(const ScenePlan& plan);

}  // namespace rayshade
