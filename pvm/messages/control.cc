// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/messages/control.h"

#include <algorithm>
#include <bit>

namespace rayshade {

bool isComplete(const Configure& message) {
  const std::size_t cells = cellCount(message.tree);
  return isComplete(message.directory, message.tree) &&
         (!message.directory.shadeTasks.empty() || message.policy.shadeLocally) &&
         message.cellBytes.size() == cells && message.cellBounds.size() == cells &&
         message.policy.outstanding > 0 && pixelArea(message.request.picture).has_value();
}

bool inTiles(const Configure& message) {
  const Directory& directory = message.directory;
  return !directory.pyramidTasks.empty() || (message.policy.shadeLocally && directory.tasksPerCluster() == 1);
}

Ray primaryRay(const FrameRequest& request, const Exposure& exposure, const SampleId& sample) {
  const SamplePosition position =
      samplePosition(request.picture, request.seed, static_cast<std::uint32_t>(exposure.frame), sample);
  return primaryRay(request.view, position, exposure.frame);
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
