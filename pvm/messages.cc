// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/messages.h"

#include <algorithm>
#include <bit>

namespace rayshade {

bool isComplete(const Directory& d, const BinTree& tree) {
  if (d.clusters == 0 || d.voxelTasks.empty() || d.voxelTasks.size() % d.clusters != 0) return false;
  if (d.voxels.size() != voxelCount(tree) || d.shadeTasks.empty()) return false;
  if (d.shadeWeights.size() != d.shadeTasks.size()) return false;
  return std::all_of(d.voxels.begin(), d.voxels.end(),
                     [&](std::uint32_t task) { return task < d.tasksPerCluster(); });
}

TaskId chooseShadeTask(const Directory& directory, RecordId record) {
  std::uint64_t sum = 0;
  for (std::uint32_t weight : directory.shadeWeights) sum += weight;
  if (sum == 0) return directory.shadeTasks[record % directory.shadeTasks.size()];
  std::uint64_t at = mixBits(record) % sum;
  std::size_t i = 0;
  while (at >= directory.shadeWeights[i]) at -= directory.shadeWeights[i++];
  return directory.shadeTasks[i];
}

Gathered gatheredFrom(const Expect& message) {
  Gathered gathered;
  gathered.light.resize(message.hit.lit.size());
  std::size_t known = 0, pending = 0;
  for (std::size_t point = 0; point < message.hit.lit.size(); ++point) {
    if (message.hit.lit[point] != Lit::asked) continue;
    if (pending < message.pending.size() && message.pending[pending] == point) {
      ++pending;
    } else {
      gathered.light[point] = message.known[known++];
    }
  }
  return gathered;
}

bool knownFits(const Expect& message) {
  std::size_t asked = 0, pending = 0;
  for (std::size_t point = 0; point < message.hit.lit.size(); ++point) {
    if (message.hit.lit[point] > Lit::asked) return false;
    if (message.hit.lit[point] != Lit::asked) continue;
    ++asked;
    if (pending < message.pending.size() && message.pending[pending] == point) ++pending;
  }
  return pending == message.pending.size() && asked == pending + message.known.size();
}

std::uint64_t arithmeticFingerprint() {
  std::uint64_t hash = 0;
  auto add = [&hash](double value) { hash = mixBits(hash ^ std::bit_cast<std::uint64_t>(value)); };
  RandomKey key = sampleKey(1, 2, 3, 4, 5);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const double x = uniform(key, Dimension::jitterX, i), y = 20 * uniform(key, Dimension::jitterY, i);
    add(std::pow(x, y));
    add(std::exp(-y));
    add(std::sin(y));
    add(std::cos(y));
    add(std::log(x + 1e-9));
    add(std::atan2(x, y));
    add(std::acos(x));
    add(std::asin(x));
    add(std::tan(x));
    add(x * y + x);  // tells a fused multiply-add
  }
  return hash;
}

}  // namespace rayshade
