// What a render by tasks has taken: gathered by the host task, printed by the host program.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pvm/messages/control.h"
#include "pvm/schedule/process_mapping.h"

namespace rayshade {

struct TaskSummary {
  Placement placement;
  TaskId task = kNobody;
  std::uint64_t objects = 0, owned = 0;
  Report report;
};

struct HostSummary {
  TaskSummary host;                // its traffic, CPU time and memory
  std::vector<TaskSummary> tasks;  // the others
  std::uint64_t objects = 0;       // of the world
  int successions = 0;             // tasks that died and were replaced
  std::uint32_t epochs = 0;
  std::uint64_t peakInFlight = 0;
  std::uint64_t reissued = 0;                                    // samples issued again
  std::uint64_t notFinite = 0;                                   // colours of samples
  double surveySeconds = 0, startSeconds = 0, traceSeconds = 0;  // start: shipping and building
};

}  // namespace rayshade
