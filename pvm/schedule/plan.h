// --plan: what rayshade-host would start, where and why, without starting it.
//
// Built from the functions that the host task uses itself - mapProcesses(), divideSpace() - so it cannot say anything else
// than what would happen.  Host files may name machines that are not there; nobody asks them.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "pvm/link/host_file.h"
#include "pvm/schedule/division.h"
#include "pvm/schedule/task_counts.h"

namespace rayshade {

// The hosts of a virtual machine once those of the host file have joined, the own one first.  `running`: its hosts now, the
// own one first; empty when none runs.  The own machine is part of it, whether the file names it or not.
std::vector<HostInfo> hostsAfterJoining(std::vector<HostInfo> running, const std::vector<HostLine>& lines,
                                        const std::function<bool(const std::string&)>& isThisMachine,
                                        const std::string& ownName);

// Lines of text: hosts, what travels, how space is divided, and the tasks with the reason for each, and for those that are
// not started.  `survey`: of the first frame.
std::string describePlan(const std::vector<HostInfo>& hosts, HostOptions options, Survey survey,
                         const FrameRequest& request, const SceneSettings& settings, const SceneWork& work);

}  // namespace rayshade
