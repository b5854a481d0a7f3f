// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/schedule/process_mapping.h"

#include <algorithm>
#include <functional>

namespace rayshade {
namespace {

// The part of each host of the memory of all; where it is not known it is taken for the mean of the others.
std::vector<double> shareOfMemory(const std::vector<HostInfo>& hosts, const HostMemories& memories) {
  std::vector<double> share(hosts.size());
  double all = 0;
  std::size_t known = 0;
  for (std::size_t i = 0; i < hosts.size(); ++i) {
    const auto memory = memories.find(hosts[i].name);
    if (memory == memories.end() || memory->second.machine == 0) continue;
    const double taken = i == 0 ? kHostTaskBytes : 0;
    share[i] = std::max(1.0, static_cast<double>(memory->second.machine) - taken);
    all += share[i];
    ++known;
  }
  const double mean = known > 0 ? all / static_cast<double>(known) : 1;
  for (double& s : share) s = (s > 0 ? s : mean) / (mean * static_cast<double>(hosts.size()));
  return share;
}

}  // namespace

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
  auto leastLoaded = [&](double more, const std::function<bool(std::size_t)>& may) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < hosts.size(); ++i)
      if (may(i) && (!best || load(i, more) < load(*best, more))) best = i;
    return best;
  };
  const auto anywhere = [](std::size_t) { return true; };
  auto put = [&](std::size_t i, double more) {
    work[i] += more;
    return hosts[i].name;
  };
  const std::uint32_t voxels = std::max(1u, wishes.clusters) * voxelTasksPerCluster(wishes, hosts.size());
  const std::uint32_t shades = wishes.shades.value_or(std::max(1u, voxels / 4));
  std::vector<Placement> placements;
  const std::vector<double> memory = shareOfMemory(hosts, wishes.memory);
  std::vector<std::uint32_t> held(hosts.size());
  const auto hasRoom = [&](std::size_t i) {
    return held[i] + 1 <= std::max(1.0, kMostMemory * voxels * memory[i]);
  };
  for (std::uint32_t i = 0; i < voxels; ++i) {
    const double more = expectedWork(Role::voxelTrace);
    const std::size_t at = leastLoaded(more, hasRoom).value_or(*leastLoaded(more, anywhere));
    ++held[at];
    placements.push_back(
        {Role::voxelTrace, i, put(at, more), "voxels spread over all hosts by speed and memory"});
  }
  for (std::uint32_t i = 0; i < wishes.pyramids; ++i) {
    // Close to the host: its own machine, unless another one is expected to be less than half as busy.
    const std::size_t other = *leastLoaded(pyramidWork, anywhere);
    const bool stay = load(0, pyramidWork) <= 2 * load(other, pyramidWork);
    placements.push_back(
        {Role::pyramidTrace, i, put(stay ? 0 : other, pyramidWork),
         stay ? "pyramids close to the host task" : "the host task's machine has enough to do"});
  }
  for (std::uint32_t i = 0; i < shades; ++i) {
    const double more = expectedWork(Role::shade);
    placements.push_back(
        {Role::shade, i, put(*leastLoaded(more, anywhere), more), "least tracing work is expected there"});
  }
  return placements;
}

}  // namespace rayshade
