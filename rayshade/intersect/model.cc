// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/intersect/model.h"

#include <algorithm>

#include "rayshade/intersect/csg.h"
#include "rayshade/intersect/ray_hit.h"

namespace rayshade {
namespace {

Bounds shapeBounds(const SceneStore& store, const PlacedObject& object) {
  return withShape(store, object, [](const auto& shape) { return shape.bounds(); });
}

}  // namespace

std::uint64_t precedence(const PlacedObject& object) {
  const std::uint64_t id = number(object.id);
  if (isFlat(object.kind)) return id;
  if (isUnbounded(object.kind)) return 1ull << 32 | id;
  return 2ull << 32 | (0xffffffffull - id);
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
  const PlacedNode& node = store_.node(object.node);
  if (node.identity) return padded(own);
  return placedBounds(
      own, node.moves, [&](const Moment& moment) { return mapAt(store_, object.node, moment); }, exposure_);
}

Region Model::regionOf(std::vector<ObjectIndex> objects) const {
  std::vector<Bounds> bounds;
  bounds.reserve(objects.size());
  std::vector<ObjectIndex> kept;
  kept.reserve(objects.size());
  for (ObjectIndex object : objects) {
    const Bounds b = boundsOf(object);
    if (b.empty()) continue;
    bounds.push_back(b);
    kept.push_back(object);
  }
  Region region;
  region.bvh = Bvh(bounds);
  region.objects.reserve(kept.size());
  for (std::uint32_t item : region.bvh.order()) region.objects.push_back(target(kept[item]));
  return region;
}

Target Model::target(ObjectIndex index) const {
  const PlacedObject& object = store_.object(index);
  Target target{index, store_.node(object.node).identity ? 0 : object.node, object.body, object.kind, true};
  if (store_.anyTransparent()) {
    // An instance or CSG is looked into only when it is hit; until then it may be transparent.
    const bool whole = object.kind != kInstanceKind && object.kind != kCsgKind;
    target.opaque = whole && store_.surfaceOrDefault(object.surface).transparency < kNegligible;
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
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (i < 2) definition.operands[i] = members[i];
      definition.bounds = join(definition.bounds, boundsOf(members[i]));
    }
    definition.region = regionOf(std::move(members));
    height[number(id)] = inside + 1;
    slots_[number(id)] = static_cast<std::uint32_t>(definitions_.size());
    definitions_.push_back(std::move(definition));
  }
}

std::size_t Model::bytes() const {
  std::size_t total = store_.bytes();
  for (const Definition& definition : definitions_) total += definition.region.bytes();
  return total;
}

LocalRay intoNode(const SceneStore& store, NodeIndex index, const LocalRay& outer, const Moment& moment) {
  const PlacedNode& node = store.node(index);
  if (node.identity) return outer;
  if (node.moves) return mappedInto(mapAt(store, index, moment).inverse, outer);
  return mappedInto(node.toContainer.inverse, outer);
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
  ObjectIndex index = hit.object;
  for (;;) {
    const PlacedObject& object = store.object(index);
    const LocalRay inner = intoNode(store, object.node, outer, ray.moment);
    path.steps.push_back({index, inner});
    if (object.kind == kInstanceKind) {
      const Hit inside = nearestHit(model, model.definition(store.instance(object)), inner, ray.moment,
                                    std::nextafter(hit.t, -kInfinity), std::nextafter(hit.t, kInfinity));
      if (!inside.found()) break;
      index = inside.object;
    } else if (object.kind == kCsgKind) {
      const CsgCrossing crossing =
          csgCrossing(model, store.csg(object), inner, ray.moment, std::nextafter(hit.t, -kInfinity));
      if (crossing.operand == kNone) break;
      // What an outer operation says about the crossing holds: it was made from what the inner one said.
      if (!path.entering) path.entering = crossing.entering;
      index = crossing.operand;
    } else {
      break;
    }
    outer = inner;
  }
  return path;
}

double rootAt(const Model& model, const PathStep& step, double t) {
  const PlacedObject& object = model.store().object(step.object);
  // Then t is the shape's own root: no rounding lies between the two.
  if (step.ray.scale == 1) return t;
  return withShape(model.store(), object, [&](const auto& shape) {
    const double local = t * step.ray.scale;
    // A few ulps below: t came from this root by a division.
    const double root = shape.intersect(step.ray, local - std::abs(local) * 4 * kRounding);
    return root < kNoHit && root <= local + std::abs(local) * 4 * kRounding ? root : local;
  });
}

}  // namespace rayshade
