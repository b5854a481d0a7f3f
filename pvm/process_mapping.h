// Which task runs where (Reinhard & Jansen, figure 6).
//
// A pure function of the hosts and of what is wished for: every task of a role goes to the host where least work per speed
// has been placed so far, voxel-trace tasks first because they are the heaviest, then shade tasks, "on those
// processors where due to the tracing processes, the load is expected to be low".  The host task's own machine comes
// first in the list and carries its work.  The successor of a dead task comes from the same function without the
// dead host.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/link.h"

namespace rayshade {

struct Wishes {
  std::uint32_t voxels = 0;  // voxel-trace tasks; 0: two per host
  std::uint32_t shades = 0;  // shade tasks; 0: one per four voxel-trace tasks, at least one
};

struct Placement {
  Role role = Role::voxelTrace;
  std::uint32_t index = 0;  // among the tasks of its role
  std::string host;
  std::string reason;
};

// Requires at least one host.
std::vector<Placement> mapProcesses(const std::vector<HostInfo>& hosts, const Wishes& wishes);

}  // namespace rayshade
