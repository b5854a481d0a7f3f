// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/schedule/process_mapping.h"

#include <algorithm>

namespace rayshade {

// Shading is "computationally rather cheap", a pyramid task is busy whenever there is work.
double expectedWork(Role role) {
  switch (role) {
    case Role::host:
      return 0.3;
    case Role::voxelTrace:
      return 1.0;
    case Role::pyramidTrace:
      return 1.5;
    case Role::shade:
      return 0.3;
  }
  return 0;
}

std::uint32_t voxelTasksPerCluster(const Wishes& wishes, std::size_t hosts) {
  if (wishes.voxels > 0) return wishes.voxels;
  return std::max(1u, 2 * static_cast<std::uint32_t>(hosts) / std::max(1u, wishes.clusters));
}

std::vector<Placement> mapProcesses(const std::vector<HostInfo>& hosts, const Wishes& wishes) {
  const double pyramidWork = expectedWork(Role::pyramidTrace);
  std::vector<double> work(hosts.size(), 0.0);
  work[0] = expectedWork(Role::host);
  auto load = [&](std::size_t i, double more) { return (work[i] + more) / std::max(hosts[i].speed, 1); };
  auto leastLoaded = [&](double more) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < hosts.size(); ++i)
      if (load(i, more) < load(best, more)) best = i;
    work[best] += more;
    return best;
  };
  const std::uint32_t voxels = std::max(1u, wishes.clusters) * voxelTasksPerCluster(wishes, hosts.size());
  const std::uint32_t shades = wishes.shades.value_or(std::max(1u, voxels / 4));
  std::vector<Placement> placements;
  for (std::uint32_t i = 0; i < voxels; ++i) {
    placements.push_back({Role::voxelTrace, i, hosts[leastLoaded(expectedWork(Role::voxelTrace))].name,
                          "voxels spread over all hosts by speed"});
  }
  for (std::uint32_t i = 0; i < wishes.pyramids; ++i) {
    // Close to the host: its own machine, unless another one is expected to be less than half as busy.
    const std::size_t other = leastLoaded(pyramidWork);
    work[other] -= pyramidWork;
    const bool stay = load(0, pyramidWork) <= 2 * load(other, pyramidWork);
    const std::size_t at = stay ? 0 : other;
    work[at] += pyramidWork;
    placements.push_back(
        {Role::pyramidTrace, i, hosts[at].name,
         stay ? "pyramids close to the host task" : "the host task's machine has enough to do"});
  }
  for (std::uint32_t i = 0; i < shades; ++i) {
    placements.push_back({Role::shade, i, hosts[leastLoaded(expectedWork(Role::shade))].name,
                          "least tracing work is expected there"});
  }
  return placements;
}

}  // namespace rayshade
