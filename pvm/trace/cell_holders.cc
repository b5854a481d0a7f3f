// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/cell_holders.h"

#include <algorithm>

namespace rayshade {

void CellHolders::begin(const Directory& directory, TaskId self) {
  self_ = self;
  tracers_.clear();
  holders_.clear();
  std::size_t finder = 0;
  for (const std::vector<TaskId>* tasks : {&directory.voxelTasks, &directory.pyramidTasks})
    for (const TaskId task : *tasks) tracers_[task] = {directory.machines[finder++], 0};
}

TaskId CellHolders::choose(CellId cell, TaskId asker) {
  const auto known = tracers_.find(asker);
  if (known == tracers_.end()) return kNobody;
  const auto isFar = [&](TaskId task) { return tracers_.at(task).machine != known->second.machine; };
  std::vector<TaskId>& holders = holders_[cell];
  TaskId chosen = self_;
  for (const TaskId holder : holders) {
    if (holder == asker) continue;
    const bool nearer = isFar(chosen) && !isFar(holder), farther = isFar(holder) && !isFar(chosen);
    if (nearer || (!farther && tracers_.at(holder).given < tracers_.at(chosen).given)) chosen = holder;
  }
  ++tracers_.at(chosen).given;
  std::erase(holders, asker);
  if (holders.size() == kMost) holders.erase(holders.begin());
  holders.push_back(asker);
  return chosen;
}

void CellHolders::forget(CellId cell, TaskId holder) {
  if (const auto holders = holders_.find(cell); holders != holders_.end())
    std::erase(holders->second, holder);
}

}  // namespace rayshade
