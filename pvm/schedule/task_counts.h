// Tasks without work are not started.
//
// The fewest rays and objects that a scene surely has say how many tasks of a kind could ever have work; those beyond are
// taken off the wishes, whoever made them.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/schedule/options.h"
#include "rayshade/program/scene_plan.h"

namespace rayshade {

struct SceneWork {
  std::uint64_t objects = 0;   // of the world
  std::uint64_t eyeRays = 0;   // of a frame, at least
  bool shadowRays = false;     // any may be sent
  bool secondaryRays = false;  // reflected or transmitted ones
};
SceneWork sceneWork(const ScenePlan& plan, std::uint64_t objects);

// The wishes of `options` for so many hosts without tasks that would have nothing to do; `why`: a line for each kind of
// which there are fewer.
struct NeededTasks {
  Wishes wishes;
  std::vector<std::string> why;
};
NeededTasks neededTasks(const SceneWork& work, const HostOptions& options, std::size_t hosts);

}  // namespace rayshade
