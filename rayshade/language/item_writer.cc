// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/item_writer.h"

namespace rayshade {

void ItemWriter::object(Scope& scope, ObjectBody body, SurfaceId surface, Modifiers modifiers) {
  NodeId node = scope.node;
  if (!modifiers.transforms.empty() || !modifiers.textures.empty()) {
    node = newNode();
    sink_->node(node,
                {scope.node, std::move(modifiers.transforms), kNoSurface, std::move(modifiers.textures)});
  }
  sink_->object({ObjectId{objects_++}, scope.container, node, surface, std::move(body)});
  ++scope.members;
}

}  // namespace rayshade
