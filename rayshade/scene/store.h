// The scene, or a task's share of it, in memory.
//
// Items come in by number and are placed: every object gets the index of its node and of the surface that binds it,
// every node its map to the space of its container.  Shapes lie in one array per type, 20 bytes more per
// object; nothing is written after prepare().
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
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
inline bool refersToDefinition(BodyKind kind) { return kind == kInstanceKind || kind == kCsgKind; }

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
  bool nowhere = false;   // toContainer has no inverse: there is nothing inside
  bool textured = false;  // this node or one further out has textures
  SceneNode node;         // as written
};

// The surfaces of a scene, by index and by number.
class StoredSurfaces {
 public:
  void add(SurfaceId id, const Surface& surface);  // again: of no effect
  // kNone: it never came.
  SurfaceIndex find(SurfaceId id) const;

  const Surface& operator[](SurfaceIndex index) const { return surfaces_[index]; }
  SurfaceId id(SurfaceIndex index) const { return ids_[index]; }
  bool anyTransparent() const { return anyTransparent_; }
  std::size_t bytes() const { return surfaces_.capacity() * sizeof(Surface); }

 private:
  std::vector<Surface> surfaces_;
  std::vector<SurfaceId> ids_;
  std::unordered_map<std::uint32_t, SurfaceIndex> index_;
  bool anyTransparent_ = false;
};

// The nodes of a scene, by index and by number; the root is always there.
class StoredNodes {
 public:
  StoredNodes();
  // How many errors of the sender were mended: a parent that cannot be, or never came.
  std::size_t add(NodeId id, SceneNode node);
  std::size_t place();  // those that came in since the last call

  std::optional<NodeIndex> find(NodeId id) const;
  const PlacedNode& operator[](NodeIndex index) const { return nodes_[index]; }
  std::size_t bytes() const;

 private:
  std::size_t place(PlacedNode& node);

  std::vector<PlacedNode> nodes_;
  std::unordered_map<std::uint32_t, NodeIndex> index_;
};

class SceneStore : public SceneSink {
 public:
  SceneStore() { members_[number(kWorld)]; }

  void surface(SurfaceId id, const Surface& surface) override { surfaces_.add(id, surface); }
  void node(NodeId id, SceneNode node) override { leftOut_ += nodes_.add(id, std::move(node)); }
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
  SurfaceId surfaceId(SurfaceIndex index) const { return index == kNone ? kNoSurface : surfaces_.id(index); }
  std::size_t objectCount() const { return objects_.size(); }

  template <class S>
  const std::vector<S>& shapes() const {
    return std::get<std::vector<S>>(shapes_);
  }
  const Instance& instance(const PlacedObject& object) const { return instances_[object.body]; }
  const Csg& csg(const PlacedObject& object) const { return csgs_[object.body]; }
  const Instance& instance(std::uint32_t body) const { return instances_[body]; }
  const Csg& csg(std::uint32_t body) const { return csgs_[body]; }
  std::size_t csgCount() const { return csgs_.size(); }

  // Is any surface of the scene transparent in shadows (before textures, as rayshade has it)?
  bool anyTransparent() const { return surfaces_.anyTransparent(); }

  // Bytes that the scene takes here, shapes and tables.
  std::size_t bytes() const;

 private:
  struct Unplaced {
    NodeId node;
    SurfaceId surface;
  };
  void place(PlacedObject& object, const Unplaced& where);

  std::vector<PlacedObject> objects_;
  std::vector<Unplaced> unplaced_;  // of the last objects
  StoredNodes nodes_;
  StoredSurfaces surfaces_;
  AllShapes::Vectors shapes_;
  std::vector<Instance> instances_;
  std::vector<Csg> csgs_;
  std::unordered_map<std::uint32_t, std::vector<ObjectIndex>> members_;  // of each container
  std::vector<DefinitionId> definitions_;                                // in the order of their first member
  std::size_t leftOut_ = 0;
  Surface default_ = defaultSurface();
};

// The moments between which things may move while a frame of an animation is exposed.
struct Exposure {
  double opens = 0, closes = 0;  // scene time
  std::int32_t frame = 0;
};

// The extent of something in the space of its container, padded: `own` mapped by what `mapAtMoment` says (nothing: it is not there
// then); when it moves, an extent that holds it at all moments of the exposure.  Host and tasks decide by it alike where an object goes.
Bounds placedBounds(const Bounds& own, bool moves,
                    const std::function<std::optional<Affine>(const Moment&)>& mapAtMoment,
                    const Exposure& exposure);

// The map from a node to the space of its container at a moment; nothing if it has no inverse then.
std::optional<Affine> mapAt(const SceneStore& store, NodeIndex node, const Moment& moment);

}  // namespace rayshade
