// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/messages/control.h"

#include <algorithm>

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

}  // namespace rayshade
