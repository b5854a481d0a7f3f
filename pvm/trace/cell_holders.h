// Who else has a cell (Reinhard & Jansen, section 6: "objects may be transferred between these processes").
//
// The owner of a voxel remembers to whom its cells went, and lets those give them on: whoever stands on the machine of the task that
// asks, else whoever has given least.  A task that has thrown a cell out, or joined it with others, sends the question back.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "pvm/messages/addresses.h"

namespace rayshade {

class CellHolders {
 public:
  // A new epoch; `self`: the owner.
  void begin(const Directory& directory, TaskId self);

  // Who gives a cell to `asker`, which is expected to have it from now on: the owner, or somebody who has it.  kNobody: the
  // asker is no task that traces.
  TaskId choose(CellId cell, TaskId asker);
  // A task does not have a cell after all.
  void forget(CellId cell, TaskId holder);

 private:
  static constexpr std::size_t kMost = 8;  // of a cell that are remembered, the last ones
  struct Tracer {
    std::uint32_t machine = 0;
    std::uint64_t given = 0;  // cells that it was to give
  };

  TaskId self_ = kNobody;
  std::map<TaskId, Tracer> tracers_;
  std::map<CellId, std::vector<TaskId>> holders_;  // by cell
};

}  // namespace rayshade
