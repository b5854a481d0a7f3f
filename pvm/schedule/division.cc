// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/schedule/division.h"

#include <algorithm>

#include "rayshade/space/cost.h"

namespace rayshade {
namespace {

// A cell is what is fetched at a time: small enough to be a part, large enough to be worth a message.
constexpr std::uint64_t kObjectsPerCell = 8192;
// Where nothing is fetched, cells only say where there is anything.
constexpr std::uint64_t kObjectsPerBox = 4, kMostBoxes = 4096;

}  // namespace

Division divideSpace(Survey& survey, const FrameRequest& request, const SceneSettings& settings,
                     const HostOptions& options, std::uint32_t tasks) {
  const std::uint32_t voxels = tasks * std::max(1u, options.voxelsPerTask);
  const bool fetches = options.wishes.pyramids > 0 || options.policy.shadows != ShadowPolicy::forward;
  const std::uint64_t bySize = fetches ? std::min<std::uint64_t>(survey.objects / kObjectsPerCell, 1 << 16)
                                       : std::min<std::uint64_t>(survey.objects / kObjectsPerBox, kMostBoxes);
  const std::uint32_t cells = options.cells > 0 ? options.cells : static_cast<std::uint32_t>(bySize);
  Division division;
  std::vector<CostBox> costs;
  if (options.split == Split::cost)
    costs = predictCost(survey.world, survey.sample, request.view, request.picture, settings);
  division.tree = buildBinTree(survey.world, {.voxels = voxels, .cells = std::max(cells, voxels)},
                               survey.density, std::move(costs));
  for (std::uint32_t voxel = 0; voxel < voxelCount(division.tree); ++voxel)
    division.owners.push_back(voxel % tasks);
  return division;
}

}  // namespace rayshade
