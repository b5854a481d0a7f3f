// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/messages.h"

#include <algorithm>
#include <bit>

namespace rayshade {

bool isComplete(const Directory& d, const BinTree& tree) {
  if (d.clusters == 0 || d.voxelTasks.empty() || d.voxelTasks.size() % d.clusters != 0) return false;
  if (d.voxels.size() != voxelCount(tree)) return false;
  if (d.shadeWeights.size() != d.shadeTasks.size()) return false;
  return std::all_of(d.voxels.begin(), d.voxels.end(),
                     [&](std::uint32_t task) { return task < d.tasksPerCluster(); });
}

bool isComplete(const Configure& message) {
  const std::size_t cells = cellCount(message.tree);
  return isComplete(message.directory, message.tree) &&
         (!message.directory.shadeTasks.empty() || message.policy.shadeAtOnce) &&
         message.cellBytes.size() == cells && message.cellContents.size() == cells &&
         message.policy.outstanding > 0;
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

Ray primaryRay(const Exhibition& exhibition, const Exposure& exposure, const SampleId& sample) {
  const SamplePosition position =
      samplePosition(exhibition.picture, exhibition.seed, static_cast<std::uint32_t>(exposure.frame), sample);
  return primaryRay(exhibition.view, position, exposure.frame);
}

bool samplesFit(const PrimaryRays& message, const PictureSpec& picture) {
  const std::int32_t cells = picture.samplesPerSide * picture.samplesPerSide;
  return !message.samples.empty() &&
         std::all_of(message.samples.begin(), message.samples.end(),
                     [cells](const SampleId& s) { return s.cell >= 0 && s.cell < cells; });
}

ShadowTravel travelOf(const ShadowRay& shadow, Slot slot, std::uint32_t step) {
  return {slot,           step,        shadow.ray.origin,    shadow.ray.direction, shadow.distance,
          shadow.through, shadow.last, shadow.insideExtinct, shadow.inside};
}

ShadowRay shadowOf(const ShadowHead& head, const ShadowTravel& travel) {
  ShadowRay shadow;
  shadow.ray.origin = travel.origin;
  shadow.ray.direction = travel.direction;
  shadow.ray.moment = head.moment;
  shadow.ray.sample = head.sample;
  shadow.ray.key = head.key;
  shadow.distance = travel.distance;
  shadow.through = travel.through;
  shadow.last = travel.last;
  shadow.insideExtinct = travel.insideExtinct;
  shadow.inside = travel.inside;
  return shadow;
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
