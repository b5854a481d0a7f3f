// Objects and nodes on their way from the parser to a sink: where they are put, and their numbers.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/language/surface_table.h"

namespace rayshade {

// Where objects are being put: the world, a definition, an aggregate.
struct Scope {
  DefinitionId container = kWorld;
  NodeId node = kRootNode;
  BoundSurface current;   // what `applysurf` has set
  bool operands = false;  // of a CSG operation: each of them stays whole
  int depth = 0;          // scopes around this one
  int members = 0;
  bool failed = false;  // something in it was wrong
  int height = 0;       // levels of aggregates and instances inside
};

// What may stand behind an object.
struct Modifiers {
  TransformChain transforms;
  std::vector<PlacedTexture> textures;
};

// Numbers follow the order of the file.
class ItemWriter {
 public:
  explicit ItemWriter(SceneSink& sink) : sink_(&sink) {}

  SceneSink& sink() { return *sink_; }
  // What is read after an error is only checked: the sink hears of nothing more.
  void silence() { sink_ = &silent_; }

  DefinitionId newDefinition() { return DefinitionId{++definitions_}; }
  NodeId newNode() { return NodeId{++nodes_}; }
  void object(Scope& scope, ObjectBody body, SurfaceId surface, Modifiers modifiers);

 private:
  class SilentSink final : public SceneSink {
   public:
    void surface(SurfaceId, const Surface&) override {}
    void node(NodeId, SceneNode) override {}
    void object(SceneObject) override {}
    void endOfStatement() override {}
  };

  SceneSink* sink_;
  SilentSink silent_;
  std::uint32_t objects_ = 0, nodes_ = 0, definitions_ = 0;
};

}  // namespace rayshade
