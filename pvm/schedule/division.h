// How space is divided over the voxel-trace tasks: the bin-tree, and which task of a cluster has which voxel.
//
// A pure function of the survey, the options and the places of the tasks: the host calls it for every frame, and --plan
// calls it without rendering.  Whatever it answers, the picture has the same bits.
//
// With Split::balanced every task gets an equal share of the bytes, as far as the memory of its host goes, and work in
// proportion to the speed of its host.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/schedule/options.h"
#include "rayshade/space/survey.h"

namespace rayshade {

// A task takes at most kPeak times what it holds, itself included, while its share comes in and accelerators are built.
inline constexpr std::uint64_t kTaskBytes = 12'000'000;
inline constexpr double kPeak = 1.25;

// Where a voxel-trace task of a cluster runs; of several clusters the worst of their places.
struct TaskPlace {
  static constexpr std::uint64_t kUnknown = ~std::uint64_t{0};
  std::string host;
  double speed = 1;               // its part of its host's
  std::uint64_t room = kUnknown;  // for its share of the model so that it can be built, bytes
};
std::vector<TaskPlace> placesOfVoxelTasks(const std::vector<HostInfo>& hosts,
                                          const std::vector<Placement>& placements, const Wishes& wishes);

struct Division {
  BinTree tree;
  std::vector<std::uint32_t> owners;  // by voxel: the task of a cluster that has it
  struct Held {
    double objects = 0, bytes = 0;
  };
  std::vector<Held> expected;      // by task: what it will hold, about
  std::uint64_t largestWhole = 0;  // the largest thing in bytes that cannot be divided
};

// What is looked at decides where the work will be.  `places`: of the tasks of a cluster, at least one.
Division divideSpace(Survey& survey, const FrameRequest& request, const SceneSettings& settings,
                     const HostOptions& options, const std::vector<TaskPlace>& places);

// Which task would hold more than it has room for, and what would be needed; "": none.
std::string whatDoesNotFit(const Division& division, const std::vector<TaskPlace>& places);

}  // namespace rayshade
