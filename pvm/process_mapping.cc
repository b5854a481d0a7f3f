// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/process_mapping.h"

#include <algorithm>

namespace rayshade {
namespace {

// Expected work of a task in parts of a voxel-trace task's: shading is "computationally rather cheap", a pyramid task is
// busy whenever there is work.
constexpr double kVoxelWork = 1.0, kPyramidWork = 1.5, kShadeWork = 0.3, kHostWork = 0.3;

}  // namespace

std::vector<Placement> mapProcesses(const std::vector<HostInfo>& hosts, const Wishes& wishes) {
  std::vector<double> work(hosts.size(), 0.0);
  work[0] = kHostWork;
  auto load = [&](std::size_t i, double more) { return (work[i] + more) / std::max(hosts[i].speed, 1); };
  auto leastLoaded = [&](double more) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < hosts.size(); ++i)
      if (load(i, more) < load(best, more)) best = i;
    work[best] += more;
    return best;
  };
  const std::uint32_t clusters = std::max(1u, wishes.clusters);
  const auto hostCount = static_cast<std::uint32_t>(hosts.size());
  const std::uint32_t voxels =
      clusters * (wishes.voxels > 0 ? wishes.voxels : std::max(1u, 2 * hostCount / clusters));
  const std::uint32_t shades = wishes.shades > 0 ? wishes.shades : std::max(1u, voxels / 4);
  std::vector<Placement> placements;
  for (std::uint32_t i = 0; i < voxels; ++i) {
    placements.push_back(
        {Role::voxelTrace, i, hosts[leastLoaded(kVoxelWork)].name, "voxels spread over all hosts by speed"});
  }
  for (std::uint32_t i = 0; i < wishes.pyramids; ++i) {
    // Close to the host: its own machine, unless another one is expected to be less than half as busy.
    const std::size_t other = leastLoaded(kPyramidWork);
    work[other] -= kPyramidWork;
    const bool stay = load(0, kPyramidWork) <= 2 * load(other, kPyramidWork);
    const std::size_t at = stay ? 0 : other;
    work[at] += kPyramidWork;
    placements.push_back(
        {Role::pyramidTrace, i, hosts[at].name,
         stay ? "pyramids close to the host task" : "the host task's machine has enough to do"});
  }
  for (std::uint32_t i = 0; i < shades; ++i) {
    placements.push_back(
        {Role::shade, i, hosts[leastLoaded(kShadeWork)].name, "least tracing work is expected there"});
  }
  return placements;
}

}  // namespace rayshade
