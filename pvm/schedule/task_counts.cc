// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/schedule/task_counts.h"

#include <algorithm>

namespace rayshade {

SceneWork sceneWork(const ScenePlan& plan, std::uint64_t objects) {
  return {objects, plan.eyeRaysAtLeast, plan.shadowRays, plan.reflectedRays || plan.transmittedRays};
}

NeededTasks neededTasks(const SceneWork& work, const HostOptions& options, std::size_t hosts) {
  NeededTasks tasks{options.wishes, {}};
  const auto lower = [&](std::uint32_t wished, std::uint64_t needed, const char* what,
                         const std::string& reason) {
    if (wished <= needed) return wished;
    tasks.why.push_back(std::to_string(needed) + " instead of " + std::to_string(wished) + " " + what + ": " +
                        reason);
    return static_cast<std::uint32_t>(needed);
  };
  tasks.wishes.voxels =
      lower(voxelTasksPerCluster(options.wishes, hosts), std::max<std::uint64_t>(work.objects, 1),
            "voxel-trace tasks", std::to_string(work.objects) + (work.objects == 1 ? " object" : " objects"));
  const std::uint64_t tile = std::max(1u, options.tilePixels);
  const std::uint64_t pyramids =
      std::max<std::uint64_t>((work.eyeRays + tile - 1) / tile, options.wishes.clusters);
  tasks.wishes.pyramids = lower(options.wishes.pyramids, pyramids, "pyramid-trace tasks",
                                "no more pyramids in the picture, of " + std::to_string(tile) + " rays");
  // Does every hit have all of its colours where it is found?
  const bool whole = tasks.wishes.voxels == 1 && tasks.wishes.pyramids == 0 && options.voxelsPerTask <= 1;
  if (options.policy.shadeLocally && (whole || (!work.secondaryRays && !work.shadowRays))) {
    tasks.wishes.shades = 0;
    tasks.why.push_back(
        std::string("no shade tasks: every hit is shaded where it is found, ") +
        (work.shadowRays || work.secondaryRays ? "where all objects are" : "no colour has to be waited for"));
  }
  return tasks;
}

}  // namespace rayshade
