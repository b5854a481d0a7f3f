// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/scene/extract.h"

namespace rayshade {
namespace {

AnyShape shapeOf(const SceneStore& store, const PlacedObject& object) {
  AnyShape shape;
  [&]<class... S>(TypeList<S...>) {
    std::size_t kind = 0;
    (void)((static_cast<std::size_t>(object.kind) == kind++ ? (shape = store.shapes<S>()[object.body], true)
                                                            : false) ||
           ...);
  }(AllShapes{});
  return shape;
}

}  // namespace

void Extract::addSurface(SurfaceId id, const Surface& surface) {
  if (surfaces_.insert(number(id)).second) items.emplace_back(SurfaceItem{id, surface});
}

// Outermost first: a node comes after its parent.
void Extract::addNodes(NodeIndex index) {
  if (index == 0) return;
  const PlacedNode& node = store_.node(index);
  if (!nodes_.insert(number(node.id)).second) return;
  addNodes(node.parent);
  SceneNode copy = node.node;
  copy.surface = kNoSurface;  // objects come with the surface that binds them
  items.emplace_back(NodeItem{node.id, std::move(copy)});
}

void Extract::add(ObjectIndex index, DefinitionId container) {
  const PlacedObject& placed = store_.object(index);
  SceneObject object;
  object.id = placed.id;
  object.container = container;
  object.node = store_.node(placed.node).id;
  object.surface = store_.surfaceId(placed.surface);
  if (placed.surface != kNone) addSurface(object.surface, store_.surface(placed.surface));
  addNodes(placed.node);
  DefinitionId used = kWorld;
  if (placed.kind == kInstanceKind) {
    object.body = store_.instance(placed);
    used = store_.instance(placed).definition;
  } else if (placed.kind == kCsgKind) {
    object.body = store_.csg(placed);
    used = store_.csg(placed).operands;
  } else {
    object.body = shapeOf(store_, placed);
  }
  if (used != kWorld && definitions_.insert(number(used)).second)
    for (ObjectIndex member : store_.objectsOf(used)) add(member, used);
  items.emplace_back(std::move(object));
}

}  // namespace rayshade
