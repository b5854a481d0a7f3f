// Spheres in a row, as items of a scene.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/scene/items.h"

namespace rayshade {

inline std::vector<Item> spheres(std::uint32_t count) {
  std::vector<Item> items;
  for (std::uint32_t i = 0; i < count; ++i) {
    SceneObject object;
    object.id = ObjectId{i};
    object.body = Sphere{{3.0 * i, 0, 0}, 1};
    items.emplace_back(object);
  }
  return items;
}

}  // namespace rayshade
