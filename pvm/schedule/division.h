// How space is divided over the voxel-trace tasks: the bin-tree, and which task of a cluster has which voxel.
//
// A pure function of the survey, the options and the number of tasks: the host calls it for every frame, and --plan
// calls it without rendering.  Whatever it answers, the picture has the same bits.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/schedule/options.h"
#include "rayshade/space/survey.h"

namespace rayshade {

struct Division {
  BinTree tree;
  std::vector<std::uint32_t> owners;  // by voxel: the task of a cluster that has it
};

// What is looked at decides where the work will be.  `tasks`: of a cluster, at least one.
Division divideSpace(Survey& survey, const FrameRequest& request, const SceneSettings& settings,
                     const HostOptions& options, std::uint32_t tasks);

}  // namespace rayshade
