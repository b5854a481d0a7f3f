// What rays meet: the objects of a scene, or of a task's share of it, ready to be visited.
//
// A Region is a set of objects with an accelerator: all of space, a voxel, a cell, or a definition in its own
// space.  nearestHit() finds the nearest hit among them; "nearest" is the minimum of a total order (t, precedence), so
// neither the order of testing nor the way in which space was cut can change the answer.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "rayshade/accel/bvh.h"
#include "rayshade/base/inline_vector.h"
#include "rayshade/intersect/solid.h"
#include "rayshade/optics/ray.h"
#include "rayshade/scene/store.h"

namespace rayshade {

// An object with all that its test by a ray needs to know but the shape itself.
struct Target {
  ObjectIndex object = kNone;
  NodeIndex node = 0;      // 0: none to go through, also when the object's own node is the identity
  std::uint32_t body = 0;  // in the array of its kind
  BodyKind kind{};
  bool opaque = true;  // as a whole: no surface bound in it lets light through
};

struct Region {
  std::vector<Target> objects;  // in the order of the leaves
  Bvh bvh;

  std::size_t bytes() const { return objects.capacity() * sizeof(Target) + bvh.bytes(); }
};

struct Hit {
  double t = kNoHit;  // world units from the origin of the ray
  ObjectIndex object = kNone;
  std::uint32_t tests = 0;  // objects that were tested, instances and CSG nodes as one each
  bool found() const { return object != kNone; }
};

// The objects, the definitions they use, and their extents during one exposure.
class Model {
 public:
  SceneStore& store() { return store_; }
  const SceneStore& store() const { return store_; }

  void take(std::vector<Item>&& items);

  // After items came in: places them and builds the regions of definitions and CSG operations.  A definition that contains
  // itself, or nests deeper than kDeepest, is emptied and counted as left out.
  void prepare(const Exposure& exposure);
  std::size_t leftOut() const { return store_.leftOut() + leftOut_; }

  Bounds boundsOf(ObjectIndex object) const;  // in the space of its container, padded
  // The extent of something inside of a node in the space of the node's container, padded.
  Bounds placedBoundsOf(const Bounds& inside, NodeIndex node) const;
  Region regionOf(std::vector<ObjectIndex> objects, unsigned threads = 1) const;
  Target target(ObjectIndex object) const;
  const Region& definition(const Instance& instance) const {
    return definitions_[slot(instance.definition)].region;
  }
  const Bounds& definitionBounds(const Instance& instance) const {
    return definitions_[slot(instance.definition)].bounds;
  }
  // What is in a definition, in the order of the file.
  std::span<const ObjectIndex> membersOf(DefinitionId definition) const {
    return definitions_[slot(definition)].members;
  }
  // The CSG operation with this body; empty if it is met as an operand of others only.
  const Solid& solid(std::uint32_t body) const { return solids_[body]; }
  std::size_t bytes() const;

  static constexpr int kDeepest = 1000;

 private:
  struct Definition {
    Region region;
    Bounds bounds;  // in its own space
    std::vector<ObjectIndex> members;
  };
  std::uint32_t slot(DefinitionId id) const {
    const auto found = slots_.find(number(id));
    return found == slots_.end() ? 0 : found->second;
  }

  SceneStore store_;
  Exposure exposure_;
  std::vector<Definition> definitions_;  // 0: an empty one, for what never came
  std::unordered_map<std::uint32_t, std::uint32_t> slots_;
  std::vector<Solid> solids_;  // by body
  std::size_t leftOut_ = 0;
};

// Which of two hits at exactly the same t is taken: the smaller.  It repeats what comes out of rayshade's order of
// testing (unbounded things first, then bounded ones from the last to the first defined; flat ones replace a hit at
// the same distance, others don't), as a property of the objects alone.
std::uint64_t precedence(const PlacedObject& object);

// The nearest hit with tMin < t < tExit among the objects of a region of world space.
Hit nearestHit(const Model& model, const Region& region, const Ray& ray, double tMin, double tExit);

// One step of the way from an object of the world down to the shape that was hit.
struct PathStep {
  ObjectIndex object = kNone;
  LocalRay ray;  // in the object's own space
};
// The steps from the world to the shape, outermost first; the last one is a shape.  `flipped` tells that a CSG
// operation turned the surface around, `entering` what CSG says about the crossing, if it says anything.
struct HitPath {
  InlineVector<PathStep, 4> steps;
  std::optional<bool> entering;
};
HitPath pathTo(const Model& model, const Ray& ray, const Hit& hit);

// What is `t` world units along the ray, where it meets the shape of a step; from the shape's own, exact root.
ShapePoint pointAt(const Model& model, const PathStep& step, double t);

// The ray in the space inside a node, `outer` being the ray in the space of the node's container.  A node that has shrunk to nothing
// at the moment has no inside: then its scale is 0, and it meets nothing.
LocalRay intoNode(const SceneStore& store, NodeIndex node, const LocalRay& outer, const Moment& moment);
inline constexpr LocalRay kNowhere{{}, {}, 0};
LocalRay mappedInto(const Matrix& inverse, const LocalRay& outer);

}  // namespace rayshade
