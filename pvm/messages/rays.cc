// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/messages/rays.h"

#include <algorithm>

namespace rayshade {

bool samplesFit(const PrimaryRays& message, const PictureSpec& picture) {
  const std::int32_t cells = picture.samplesPerSide * picture.samplesPerSide;
  return !message.samples.empty() &&
         std::all_of(message.samples.begin(), message.samples.end(),
                     [cells](const SampleId& s) { return s.cell >= 0 && s.cell < cells; });
}

bool fits(const Tile& tile, const SamplingRules& rules) {
  return tile.x >= 0 && tile.y >= 0 && tile.width > 0 && tile.height > 0 && tile.width <= rules.area.width &&
         tile.height <= rules.rowCount && tile.x <= rules.area.width - tile.width &&
         tile.y <= rules.rowCount - tile.height && tile.width <= kMostTilePixels / tile.height;
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

}  // namespace rayshade
