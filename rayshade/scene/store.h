// The scene, or a task's share of it, in memory.
//
// Items come in by number and are placed: every object gets the index of its node and of the surface that binds it,
// every node its map to the space of its container.  Shapes lie in one array per type, 20 bytes more per
// object; nothing is written after prepare().
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "rayshade/scene/items.h"

namespace rayshade {

using ObjectIndex = std::uint32_t;   // into SceneStore::objects
using NodeIndex = std::uint32_t;     // into SceneStore::nodes; 0 is the root
using SurfaceIndex = std::uint32_t;  // into SceneStore::surfaces
inline constexpr std::uint32_t kNone = 0xffffffffu;

// What an object is: a position in AllShapes, or one of the two kinds that refer to a definition.
enum class BodyKind : std::uint8_t {};
inline constexpr BodyKind kInstanceKind{AllShapes::size};
inline constexpr BodyKind kCsgKind{AllShapes::size + 1};

struct PlacedObject {
  ObjectId id{};
  NodeIndex node = 0;
  SurfaceIndex surface = kNone;  // the innermost one inside its container; kNone: look at what contains it
  std::uint32_t body = 0;        // in the array of its kind
  BodyKind kind{};
};

struct PlacedNode {
  NodeId id = kRootNode;
  NodeIndex parent = 0;
  Affine toContainer;     // when nothing on the way moves
  bool moves = false;     // something on the way to the container does
  bool identity = true;   // toContainer is the identity
  bool textured = false;  // this node or one further out has textures
  SceneNode node;         // as written
};

class SceneStore : public SceneSink {
 public:
  SceneStore();

  void surface(SurfaceId id, const Surface& surface) override;
  void node(NodeId id, SceneNode node) override;
  void object(SceneObject object) override;
  void endOfStatement() override {}

  // Places what came in since the last call.  An object whose node, surface or definition never came is an error of
  // the sender: it is left out and counted.
  void prepare();
  std::size_t leftOut() const { return leftOut_; }

  std::span<const ObjectIndex> objectsOf(DefinitionId definition) const;
  std::vector<DefinitionId> definitions() const;  // all but the world, inner ones first

  const PlacedObject& object(ObjectIndex index) const { return objects_[index]; }
  const PlacedNode& node(NodeIndex index) const { return nodes_[index]; }
  const Surface& surface(SurfaceIndex index) const { return surfaces_[index]; }
  const Surface& surfaceOrDefault(SurfaceIndex index) const {
    return index == kNone ? default_ : surfaces_[index];
  }
  SurfaceId surfaceId(SurfaceIndex index) const { return index == kNone ? kNoSurface : surfaceIds_[index]; }
  std::size_t objectCount() const { return objects_.size(); }

  template <class S>
  const std::vector<S>& shapes() const {
    return std::get<std::vector<S>>(shapes_);
  }
  const Instance& instance(const PlacedObject& object) const { return instances_[object.body]; }
  const Csg& csg(const PlacedObject& object) const { return csgs_[object.body]; }
  const Instance& instance(std::uint32_t body) const { return instances_[body]; }
  const Csg& csg(std::uint32_t body) const { return csgs_[body]; }

  // Is any surface of the scene transparent in shadows (before textures, as rayshade has it)?
  bool anyTransparent() const { return anyTransparent_; }

  // Bytes that the scene takes here, shapes and tables.
  std::size_t bytes() const;

 private:
  void place(PlacedNode& node);

  std::vector<PlacedObject> objects_;
  std::vector<PlacedNode> nodes_;
  std::vector<Surface> surfaces_;
  std::vector<SurfaceId> surfaceIds_;
  AllShapes::Vectors shapes_;
  std::vector<Instance> instances_;
  std::vector<Csg> csgs_;
  std::unordered_map<std::uint32_t, NodeIndex> nodeIndex_;
  std::unordered_map<std::uint32_t, SurfaceIndex> surfaceIndex_;
  std::unordered_map<std::uint32_t, std::vector<ObjectIndex>> members_;  // of each container
  std::vector<DefinitionId> definitions_;                                // in the order of their first member
  std::vector<NodeId> unplacedFrame_;                                    // of the objects since `placed_`
  std::vector<SurfaceId> unplacedSurface_;
  std::size_t placed_ = 0;
  std::size_t leftOut_ = 0;
  bool anyTransparent_ = false;
  Surface default_ = defaultSurface();
};

// The moments between which things may move while a frame of an animation is exposed.
struct Exposure {
  double opens = 0, closes = 0;  // scene time
  std::int32_t frame = 0;
};

// The extent of something in the space of its container, padded: `own` mapped by what `mapAtMoment` says; when it
// moves, an extent that holds it at all moments of the exposure.  Host and tasks decide by it alike where an object goes.
Bounds placedBounds(const Bounds& own, bool moves, const std::function<Affine(const Moment&)>& mapAtMoment,
                    const Exposure& exposure);

// The map from a node to the space of its container at a moment.
Affine mapAt(const SceneStore& store, NodeIndex node, const Moment& moment);

}  // namespace rayshade
