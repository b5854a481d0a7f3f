// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/process_mapping.h"

#include <algorithm>

namespace rayshade {
namespace {

// Expected work of a task in parts of a voxel-trace task's: shading is "computationally rather cheap".
constexpr double kVoxelWork = 1.0, kShadeWork = 0.3, kHostWork = 0.3;

}  // namespace

std::vector<Placement> mapProcesses(const std::vector<HostInfo>& hosts, const Wishes& wishes) {
  std::vector<double> work(hosts.size(), 0.0);
  work[0] = kHostWork;
  auto leastLoaded = [&](double more) {
    std::size_t best = 0;
    auto load = [&](std::size_t i) { return (work[i] + more) / std::max(hosts[i].speed, 1); };
    for (std::size_t i = 1; i < hosts.size(); ++i)
      if (load(i) < load(best)) best = i;
    work[best] += more;
    return best;
  };
  const std::uint32_t voxels = wishes.voxels > 0 ? wishes.voxels : 2 * static_cast<std::uint32_t>(hosts.size());
  const std::uint32_t shades = wishes.shades > 0 ? wishes.shades : std::max(1u, voxels / 4);
  std::vector<Placement> placements;
  for (std::uint32_t i = 0; i < voxels; ++i) {
    placements.push_back({Role::voxelTrace, i, hosts[leastLoaded(kVoxelWork)].name, "voxels spread over all hosts by speed"});
  }
  for (std::uint32_t i = 0; i < shades; ++i) {
    placements.push_back({Role::shade, i, hosts[leastLoaded(kShadeWork)].name, "least tracing work is expected there"});
  }
  return placements;
}

}  // namespace rayshade
