// Which task runs where (Reinhard & Jansen, figure 6).
//
// A pure function of the hosts and of what is wished for.  Every task goes to the host where, with it, least work per
// speed is expected:
//   - voxel-trace tasks spread over all hosts, cluster by cluster; but no host gets so many that their share of the model is
//     more than kMostMemory of its share of the memory;
//   - pyramid-trace tasks on the host task's own machine, "close to the host processor", unless another one is expected to
//     be less than half as busy;
//   - shade tasks last, "on those processors where due to the tracing processes, the load is expected to be low".
// The successor of a dead task comes from the same function without the dead host.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>

#include "pvm/link/link.h"

namespace rayshade {

// What is known of the memory of a host, in bytes; 0: nothing.
struct HostMemory {
  std::uint64_t machine = 0;   // for all of our tasks together
  std::uint64_t eachTask = 0;  // for each process
};
using HostMemories = std::map<std::string, HostMemory>;  // by name

inline constexpr double kMostMemory = 1.5;
inline constexpr std::uint64_t kHostTaskBytes = 48'000'000;  // what the host task takes of its own machine

struct Wishes {
  std::uint32_t voxels = 0;  // voxel-trace tasks of each cluster; 0: two per host, shared among the clusters
  std::uint32_t pyramids = 0;  // pyramid-trace tasks
  std::optional<std::uint32_t>
      shades{};                // shade tasks; nothing: one per four voxel-trace tasks, at least one
  std::uint32_t clusters = 1;  // copies of the model
  HostMemories memory{};       // of hosts that are known
};

struct Placement {
  Role role = Role::voxelTrace;
  std::uint32_t index = 0;  // among the tasks of its role
  std::string host;
  std::string reason;
};

// Work of a task of this role in parts of a voxel-trace task's, before anything is known of the scene.
double expectedWork(Role role);

// Voxel-trace tasks of each cluster, when there are so many hosts.
std::uint32_t voxelTasksPerCluster(const Wishes& wishes, std::size_t hosts);

// Requires at least one host.
std::vector<Placement> mapProcesses(const std::vector<HostInfo>& hosts, const Wishes& wishes);

}  // namespace rayshade
