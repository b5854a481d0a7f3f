// What a scene consists of.
//
// A scene is a stream of items.  Objects stand in the world or in a definition; `list`, `grid` and the
// instance of a primitive leave no trace but a node: anonymous aggregates are dissolved into their members
// while the scene is read.  What must stay whole - a named object, the two operands of a CSG operation - is a
// definition, and an object that uses it names it.
//
//   SceneNode          a step of the naming tree: transforms, surface, textures, parent
//   SceneObject    a shape in a node
//   definition     objects under a node tree of their own (its root is again kRootNode)
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rayshade/base/ids.h"
#include "rayshade/base/transform.h"
#include "rayshade/optics/surface.h"
#include "rayshade/shapes/all.h"
#include "rayshade/textures/all.h"

namespace rayshade {

// A texture as it hangs on a node: its own transforms map the space of the node's parent to the texture's.
struct PlacedTexture {
  AnyTexture texture;
  TransformChain transforms;
};

// From the space of what is inside the node to the space of its parent.
struct SceneNode {
  NodeId parent = kRootNode;
  TransformChain transforms;
  SurfaceId surface = kNoSurface;       // for everything inside that has none of its own
  std::vector<PlacedTexture> textures;  // applied after those of the things inside, in this order
};

// `object NAME`: the definition as a whole, placed.
struct Instance {
  DefinitionId definition = kWorld;
};

enum class CsgOperation : std::uint8_t { unite, intersect, subtract };

// A CSG node: its definition holds the operands, two or more, in the order of the file.
struct Csg {
  CsgOperation operation = CsgOperation::unite;
  DefinitionId operands = kWorld;
};

using ObjectBody = std::variant<AnyShape, Instance, Csg>;

struct SceneObject {
  ObjectId id{};
  DefinitionId container = kWorld;
  NodeId node = kRootNode;
  SurfaceId surface = kNoSurface;  // its own, if it has one
  ObjectBody body;
};

// An item as it is spooled or sent.
struct SurfaceItem {
  SurfaceId id{};
  Surface surface;
};
struct NodeItem {
  NodeId id{};
  SceneNode node;
};
using Item = std::variant<SurfaceItem, NodeItem, SceneObject>;

// Takes the items of a scene one by one while it is read.
//
// Order: a node or surface comes before what mentions it, and surfaces are numbered 0, 1, 2... as they come.  There is
// one exception.  The transforms of an
// aggregate stand behind its `end`, so its node comes after its members; `endOfStatement` is called whenever every
// node mentioned so far is known (at the end of each top-level statement).  A definition comes before its
// first use.
class SceneSink {
 public:
  virtual ~SceneSink() = default;
  virtual void surface(SurfaceId id, const Surface& surface) = 0;
  virtual void node(NodeId id, SceneNode node) = 0;
  virtual void object(SceneObject object) = 0;
  virtual void endOfStatement() = 0;
};

// In items.cc, both directions: shapes and textures of every kind take long to compile, and many files read or write
// items.
void serialize(Writer& archive, SceneNode& f);
void serialize(Reader& archive, SceneNode& f);
void serialize(Writer& archive, SceneObject& o);
void serialize(Reader& archive, SceneObject& o);

template <class Archive>
void serialize(Archive& archive, Instance& i) {
  archive(i.definition);
}
template <class Archive>
void serialize(Archive& archive, Csg& c) {
  archive(c.operation, c.operands);
}
template <class Archive>
void serialize(Archive& archive, SurfaceItem& i) {
  archive(i.id, i.surface);
}
template <class Archive>
void serialize(Archive& archive, NodeItem& i) {
  archive(i.id, i.node);
}

}  // namespace rayshade
