// Objects of a store as items again, with all that they refer to: a cell for somebody else's cache.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>

#include "rayshade/scene/store.h"

namespace rayshade {

class Extract {
 public:
  explicit Extract(const SceneStore& store) : store_(store) {}

  // Adds an object of the world and, unless they are there already, its nodes, surface and definitions.
  void add(ObjectIndex object) { add(object, kWorld); }

  std::vector<Item> items;

 private:
  void add(ObjectIndex object, DefinitionId container);
  void addNodes(NodeIndex node);
  void addSurface(SurfaceId id, const Surface& surface);

  const SceneStore& store_;
  std::set<std::uint32_t> nodes_, surfaces_, definitions_;
};

}  // namespace rayshade
