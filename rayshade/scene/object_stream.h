// From a stream of items to a stream of placed objects, in bounded memory.
//
// The transforms of an aggregate stand behind its members, so where a member goes is known only at the end of its
// top-level statement.  Until then the items of the statement are spooled (to disk when they are many); then they are
// read back and handed on with their bounds.  Definitions stay in a spool, and can be read back as often as they are
// used, and so do surfaces.  What is kept in memory: nodes that came after their members, and an entry per definition.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <unordered_map>

#include "rayshade/scene/spool.h"
#include "rayshade/scene/store.h"

namespace rayshade {

class ObjectStream : public SceneSink {
 public:
  // What comes into a task's memory with an object that nothing before it brought along.
  struct Brought {
    std::uint64_t bytes = 0;       // the object itself and its nodes
    std::uint64_t definition = 0;  // and all that is in the definition that it uses
  };
  // Takes an object of the world with its bounds in world space.  `nodes` are those between it and the world, in the
  // order of their numbers.
  using Consumer = std::function<void(const SceneObject& object, const Bounds& bounds,
                                      std::span<const NodeItem* const> nodes, const Brought& brought)>;

  ObjectStream(const Exposure& exposure, Consumer consumer);

  void surface(SurfaceId id, const Surface& surface) override;
  void node(NodeId id, SceneNode node) override;
  void object(SceneObject object) override;
  void endOfStatement() override;

  std::optional<Surface> findSurface(SurfaceId id);
  // What a definition consists of: nodes and objects, nodes in any order; other definitions that it uses are
  // mentioned only.
  void readDefinition(DefinitionId id, const std::function<void(const Item&)>& item);

  std::uint64_t objects() const { return objects_; }  // of the world

 private:
  struct SpooledDefinition {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> pieces;  // offset and size in definitionSpool_
    Bounds bounds;
    std::uint64_t bytes = 0;  // until an object has brought it along
  };
  struct Statement {  // the top-level statement that is being read
    Spool spool;
    std::map<std::uint32_t, NodeItem> late;  // nodes that came after something that mentions them
    std::uint32_t mentioned = 0;             // the largest number of a node so far
    std::vector<DefinitionId> defined;       // in order
  };

  void note(NodeId id);
  void spool(const Item& item, Spool& to);
  Bounds ownBounds(const SceneObject& object) const;
  std::vector<const NodeItem*> nodesOf(NodeId id, const NodeItem* own) const;
  void hand(const SceneObject& object, const NodeItem* own);
  Brought broughtBy(const SceneObject& object, std::span<const NodeItem* const> chain);

  Exposure exposure_;
  Consumer consumer_;
  Spool surfaceSpool_;  // records of one size, in the order of their numbers
  std::unordered_map<std::uint32_t, SpooledDefinition> definitions_;
  Spool definitionSpool_;
  Statement statement_;
  std::uint64_t objects_ = 0;
  std::uint32_t broughtNode_ = 0;  // the largest number of those that objects hang on
  Bytes scratch_;
};

}  // namespace rayshade
