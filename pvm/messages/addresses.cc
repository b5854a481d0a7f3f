// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/messages/addresses.h"

#include <algorithm>

#include "rayshade/base/random.h"

namespace rayshade {

bool isComplete(const Directory& d, const BinTree& tree) {
  if (d.clusters == 0 || d.voxelTasks.empty() || d.voxelTasks.size() % d.clusters != 0) return false;
  if (d.voxels.size() != voxelCount(tree)) return false;
  if (d.machines.size() != finderCount(d)) return false;
  if (d.shadeWeights.size() != d.shadeTasks.size()) return false;
  return std::all_of(d.voxels.begin(), d.voxels.end(),
                     [&](std::uint32_t task) { return task < d.tasksPerCluster(); });
}

std::uint32_t tracersBeside(const Directory& directory, std::size_t finder) {
  const std::vector<std::uint32_t>& machines = directory.machines;
  return static_cast<std::uint32_t>(std::count(machines.begin(), machines.end(), machines[finder]));
}

std::optional<std::uint32_t> placeAmong(const std::vector<TaskId>& tasks, TaskId task) {
  const auto found = std::find(tasks.begin(), tasks.end(), task);
  if (found == tasks.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - tasks.begin());
}

bool isTracer(const Directory& directory, TaskId task) {
  return placeAmong(directory.voxelTasks, task) || placeAmong(directory.pyramidTasks, task);
}

std::size_t chooseShadeTask(const Directory& directory, std::uint64_t serial) {
  if (directory.shadeTasks.size() <= 1) return 0;
  std::uint64_t sum = 0;
  for (std::uint32_t weight : directory.shadeWeights) sum += weight;
  if (sum == 0) return serial % directory.shadeTasks.size();
  std::uint64_t at = mixBits(serial) % sum;
  std::size_t i = 0;
  while (at >= directory.shadeWeights[i]) at -= directory.shadeWeights[i++];
  return i;
}

}  // namespace rayshade
