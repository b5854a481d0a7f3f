// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/intersect/model.h"

#include <algorithm>
#include <array>
#include <unordered_set>

#include "rayshade/intersect/csg.h"
#include "rayshade/intersect/ray_hit.h"

namespace rayshade {
namespace {

Bounds shapeBounds(const SceneStore& store, const PlacedObject& object) {
  return withShape(store, object, [](const auto& shape) { return shape.bounds(); });
}

// What goes first of two hits at the same t, by BodyKind; instances and CSG nodes are solids.
enum class Turn : std::uint8_t { flat, unbounded, solid };
constexpr auto kTurns = [] {
  std::array<Turn, AllShapes::size + 2> turns;
  turns.fill(Turn::solid);
  std::size_t kind = 0;
  AllShapes::forEach([&]<class S>() {
    static_assert(!(S::flat && S::unbounded), "a shape is flat or unbounded: see precedence()");
    turns[kind++] = S::flat ? Turn::flat : S::unbounded ? Turn::unbounded : Turn::solid;
  });
  return turns;
}();
static_assert(static_cast<std::size_t>(kInstanceKind) < kTurns.size() &&
              static_cast<std::size_t>(kCsgKind) < kTurns.size());

}  // namespace

std::uint64_t precedence(const PlacedObject& object) {
  const std::uint64_t id = number(object.id);
  switch (kTurns[static_cast<std::size_t>(object.kind)]) {
    case Turn::flat:
      return id;
    case Turn::unbounded:
      return 1ull << 32 | id;
    default:
      return 2ull << 32 | (0xffffffffull - id);
  }
}

Bounds Model::boundsOf(ObjectIndex index) const {
  const PlacedObject& object = store_.object(index);
  Bounds own;
  if (object.kind == kInstanceKind) {
    own = definitions_[slot(store_.instance(object).definition)].bounds;
  } else if (object.kind == kCsgKind) {
    own = definitions_[slot(store_.csg(object).operands)].bounds;
  } else {
    own = shapeBounds(store_, object);
  }
  return placedBoundsOf(own, object.node);
}

Bounds Model::placedBoundsOf(const Bounds& inside, NodeIndex index) const {
  const PlacedNode& node = store_.node(index);
  if (node.identity) return padded(inside);
  return placedBounds(
      inside, node.moves, [&](const Moment& moment) { return mapAt(store_, index, moment); }, exposure_);
}

Region Model::regionOf(std::vector<ObjectIndex> objects, unsigned threads) const {
  Region region;
  region.bvh = Bvh(
      objects.size(), [&](std::uint32_t item) { return boundsOf(objects[item]); }, threads);
  const std::vector<std::uint32_t> order = region.bvh.takeOrder();
  region.objects.reserve(region.bvh.held());  // the others are nowhere
  for (const std::uint32_t item : std::span(order).first(region.bvh.held()))
    region.objects.push_back(target(objects[item]));
  return region;
}

Target Model::target(ObjectIndex index) const {
  const PlacedObject& object = store_.object(index);
  Target target{index, store_.node(object.node).identity ? 0 : object.node, object.body, object.kind, true};
  if (store_.anyTransparent()) {
    // An instance or CSG is looked into only when it is hit; until then it may be transparent.
    target.opaque = !refersToDefinition(object.kind) &&
                    store_.surfaceOrDefault(object.surface).transparency < kNegligible;
  }
  return target;
}

void Model::take(std::vector<Item>&& items) {
  for (Item& item : items) {
    if (auto* surface = std::get_if<SurfaceItem>(&item)) {
      store_.surface(surface->id, surface->surface);
    } else if (auto* node = std::get_if<NodeItem>(&item)) {
      store_.node(node->id, std::move(node->node));
    } else {
      store_.object(std::move(std::get<SceneObject>(item)));
    }
  }
}

void Model::prepare(const Exposure& exposure) {
  exposure_ = exposure;
  store_.prepare();
  definitions_.assign(1, {});
  slots_.clear();
  std::unordered_map<std::uint32_t, int> height;  // of nesting inside a definition
  std::unordered_set<std::uint32_t> operands;     // definitions that are met only through their operation
  for (std::uint32_t body = 0; body < store_.csgCount(); ++body)
    operands.insert(number(store_.csg(body).operands));
  for (DefinitionId id : store_.definitions()) {
    std::vector<ObjectIndex> members;
    int inside = 0;
    for (ObjectIndex index : store_.objectsOf(id)) {
      const PlacedObject& object = store_.object(index);
      const DefinitionId used = object.kind == kInstanceKind ? store_.instance(object).definition
                                : object.kind == kCsgKind    ? store_.csg(object).operands
                                                             : kWorld;
      const auto known = height.find(number(used));
      // What is used was defined before: this also rules out circles.
      const bool good = used == kWorld ? object.kind != kInstanceKind && object.kind != kCsgKind
                                       : known != height.end() && known->second < kDeepest;
      if (!good) {
        ++leftOut_;
        continue;
      }
      if (used != kWorld) inside = std::max(inside, known->second);
      members.push_back(index);
    }
    Definition definition;
    for (ObjectIndex member : members) definition.bounds = join(definition.bounds, boundsOf(member));
    if (!operands.contains(number(id))) definition.region = regionOf(members);
    definition.members = std::move(members);
    height[number(id)] = inside + 1;
    slots_[number(id)] = static_cast<std::uint32_t>(definitions_.size());
    definitions_.push_back(std::move(definition));
  }
  std::vector<bool> isOperand(store_.objectCount());
  for (std::uint32_t id : operands)
    for (ObjectIndex member : membersOf(DefinitionId{id})) isOperand[member] = true;
  solids_ = std::vector<Solid>(store_.csgCount());
  for (ObjectIndex index = 0; index < store_.objectCount(); ++index) {
    const PlacedObject& object = store_.object(index);
    if (object.kind == kCsgKind && !isOperand[index])
      solids_[object.body] = solidOf(*this, store_.csg(object), exposure_);
  }
}

std::size_t Model::bytes() const {
  std::size_t total = store_.bytes();
  for (const Definition& definition : definitions_)
    total += definition.region.bytes() + definition.members.capacity() * sizeof(ObjectIndex);
  for (const Solid& solid : solids_) total += solid.bytes();
  return total;
}

LocalRay intoNode(const SceneStore& store, NodeIndex index, const LocalRay& outer, const Moment& moment) {
  const PlacedNode& node = store.node(index);
  if (node.identity) return outer;
  if (node.moves) {
    const std::optional<Affine> map = mapAt(store, index, moment);
    return map ? mappedInto(map->inverse, outer) : kNowhere;
  }
  return node.nowhere ? kNowhere : mappedInto(node.toContainer.inverse, outer);
}

LocalRay mappedInto(const Matrix& inverse, const LocalRay& outer) {
  const Vec3 direction = mapVector(inverse, outer.direction);
  const double scale = length(direction);
  return {mapPoint(inverse, outer.origin), direction / scale, outer.scale * scale};
}

Hit nearestHit(const Model& model, const Region& region, const Ray& ray, double tMin, double tExit) {
  return nearestHit(model, region, {ray.origin, ray.direction, 1}, ray.moment, tMin, tExit);
}

HitPath pathTo(const Model& model, const Ray& ray, const Hit& hit) {
  const SceneStore& store = model.store();
  HitPath path;
  LocalRay outer{ray.origin, ray.direction, 1};
  const auto step = [&](ObjectIndex index) {
    outer = intoNode(store, store.object(index).node, outer, ray.moment);
    path.steps.push_back({index, outer});
  };
  // Goes on among the objects of a region.  False: nothing is there.
  const auto enter = [&](const Region& region, ObjectIndex& index) {
    index = hitAt(model, region, outer, ray.moment, hit.t).object;
    return index != kNone;
  };
  for (ObjectIndex index = hit.object;;) {
    step(index);
    const PlacedObject& object = store.object(index);
    if (object.kind == kInstanceKind) {
      if (!enter(model.definition(store.instance(object)), index)) break;
    } else if (object.kind == kCsgKind) {
      const Solid& solid = model.solid(object.body);
      const Crossing crossing = crossingAt(model, solid, outer, ray.moment, hit.t);
      if (!crossing.exists()) break;
      // What an outer operation says about the crossing holds: it was made from what the inner one said.
      if (!path.entering) path.entering = crossing.entering;
      const Solid::Leaf& leaf = solid.leaves[crossing.leaf];
      for (ObjectIndex inside : wayTo(solid, leaf)) step(inside);
      if (leaf.sheets == nullptr || !enter(*leaf.sheets, index)) break;
    } else {
      break;
    }
  }
  return path;
}

ShapePoint pointAt(const Model& model, const PathStep& step, double t) {
  return withShape(model.store(), model.store().object(step.object), [&](const auto& shape) {
    // Then t is the shape's own root: no rounding lies between the two.
    if (step.ray.scale == 1) return shape.pointAt(step.ray, t);
    const double local = t * step.ray.scale;
    // A few ulps below: t came from this root by a division.
    const double root = shape.intersect(step.ray, local - std::abs(local) * 4 * kRounding);
    return shape.pointAt(step.ray,
                         root < kNoHit && root <= local + std::abs(local) * 4 * kRounding ? root : local);
  });
}

}  // namespace rayshade
