// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/intersect/solid.h"

#include <algorithm>
#include <numeric>

#include "rayshade/intersect/model.h"
#include "rayshade/intersect/placing.h"
#include "rayshade/intersect/ray_hit.h"

namespace rayshade {
namespace {

// With so many leaves, what a further name stands for is not taken apart any more but is one leaf, whose members should not
// overlap.  Otherwise names that use names twice would need memory without end.
constexpr std::size_t kMostLeaves = 4096;

bool isOpen(const SceneStore& store, const PlacedObject& object) {
  return !refersToDefinition(object.kind) &&
         withShape(store, object, []<class S>(const S&) { return !S::solid; });
}

class SolidBuilder {
 public:
  SolidBuilder(const Model& model, const Exposure& exposure) : model_(model), exposure_(exposure) {}

  Solid build(const Csg& csg) {
    operands(model_.membersOf(csg.operands), enter(csg.operation, {}), kNone);
    std::vector<Bounds> bounds;
    for (const Solid::Leaf& leaf : solid_.leaves) bounds.push_back(leaf.bounds);
    solid_.bvh = Bvh(bounds);
    solid_.extent = extent();
    return std::move(solid_);
  }

 private:
  // Where the first operand of an operation stands that is itself at `place`: often it is no more than further operands of the
  // operation around it.
  Solid::Place enter(CsgOperation kind, Solid::Place place) {
    if (place.operation != kNone) {
      Solid::Operation& outer = solid_.operations[place.operation];
      const CsgOperation joining = outer.kind != CsgOperation::subtract ? outer.kind
                                   : place.first                        ? CsgOperation::subtract
                                                                        : CsgOperation::unite;
      if (kind == joining) return place;
      ++outer.operands;
    }
    solid_.operations.push_back({kind, place, 0});
    return {static_cast<std::uint32_t>(solid_.operations.size() - 1), true};
  }

  void operands(std::span<const ObjectIndex> objects, Solid::Place place, std::uint32_t outer) {
    for (ObjectIndex object : objects) {
      operand(object, place, outer);
      place.first = false;
    }
  }

  void operand(ObjectIndex index, Solid::Place place, std::uint32_t outer) {
    const SceneStore& store = model_.store();
    const PlacedObject& object = store.object(index);
    const PlacedNode& node = store.node(object.node);
    std::uint32_t step = outer;
    if (!refersToDefinition(object.kind) || !node.identity || node.textured || object.surface != kNone) {
      step = static_cast<std::uint32_t>(solid_.steps.size());
      const std::uint32_t outside = outer == kNone ? kNone : solid_.steps[outer].space;
      solid_.steps.push_back({index, outer, node.identity ? outside : step});
    }
    if (object.kind == kCsgKind) {
      const Csg& csg = store.csg(object);
      operands(model_.membersOf(csg.operands), enter(csg.operation, place), step);
    } else if (object.kind == kInstanceKind) {
      list(store.instance(object), place, step);
    } else {
      withShape(store, object, [&]<class S>(const S& shape) {
        leaf(place, step, nullptr, shape.bounds(), S::solid && S::unbounded);
        return 0;
      });
    }
  }

  // The union of the members.
  void list(const Instance& instance, Solid::Place place, std::uint32_t step) {
    const std::span<const ObjectIndex> members = model_.membersOf(instance.definition);
    if (members.size() == 1) return operand(members[0], place, step);
    const auto whole = [&] {
      leaf(place, step, &model_.definition(instance), model_.definitionBounds(instance));
    };
    if (solid_.leaves.size() + members.size() > kMostLeaves) return whole();
    std::vector<ObjectIndex> sheets, solids;
    for (ObjectIndex member : members)
      (isOpen(model_.store(), model_.store().object(member)) ? sheets : solids).push_back(member);
    std::vector<std::vector<ObjectIndex>> groups = touching(std::move(sheets));
    if (solids.empty() && groups.size() == 1) return whole();
    Solid::Place within = enter(CsgOperation::unite, place);
    operands(solids, within, step);
    within.first = within.first && solids.empty();
    for (std::vector<ObjectIndex>& group : groups) {
      if (group.size() == 1) {
        operand(group[0], within, step);
      } else {
        Bounds bounds;
        for (ObjectIndex sheet : group) bounds = join(bounds, model_.boundsOf(sheet));
        solid_.own.push_back(std::make_unique<Region>(model_.regionOf(std::move(group))));
        leaf(within, step, solid_.own.back().get(), bounds);
      }
      within.first = false;
    }
  }

  // Sorts objects into groups: what touches may belong together, what stands apart does not.
  std::vector<std::vector<ObjectIndex>> touching(std::vector<ObjectIndex> objects) const {
    std::vector<Bounds> bounds;
    for (ObjectIndex object : objects) bounds.push_back(model_.boundsOf(object));
    std::vector<std::size_t> byX(objects.size()), leader(objects.size());
    std::iota(byX.begin(), byX.end(), 0);
    std::iota(leader.begin(), leader.end(), 0);
    std::sort(byX.begin(), byX.end(),
              [&](std::size_t a, std::size_t b) { return bounds[a].low.x < bounds[b].low.x; });
    const auto find = [&](std::size_t i) {
      while (leader[i] != i) i = leader[i] = leader[leader[i]];
      return i;
    };
    for (std::size_t i = 0; i < byX.size(); ++i)
      for (std::size_t k = i + 1; k < byX.size() && bounds[byX[k]].low.x <= bounds[byX[i]].high.x; ++k)
        if (overlap(bounds[byX[i]], bounds[byX[k]])) {
          const std::size_t a = find(byX[i]), b = find(byX[k]);
          leader[std::max(a, b)] = std::min(a, b);
        }
    std::vector<std::vector<ObjectIndex>> groups(objects.size());
    for (std::size_t i = 0; i < objects.size(); ++i) groups[find(i)].push_back(objects[i]);
    std::erase_if(groups, [](const auto& group) { return group.empty(); });
    return groups;
  }

  // From the leaves up to the result: a difference has no more room than its first operand.
  Bounds extent() const {
    std::vector<Bounds> room(solid_.operations.size());
    for (std::size_t i = 0; i < room.size(); ++i)
      if (solid_.operations[i].kind == CsgOperation::intersect) room[i] = kEverywhere;
    const auto take = [&](const Solid::Place& place, const Bounds& operand) {
      Bounds& whole = room[place.operation];
      switch (solid_.operations[place.operation].kind) {
        case CsgOperation::unite:
          whole = join(whole, operand);
          break;
        case CsgOperation::intersect:
          whole = common(whole, operand);
          break;
        case CsgOperation::subtract:
          if (place.first) whole = operand;
          break;
      }
    };
    for (const Solid::Leaf& leaf : solid_.leaves) take(leaf.place, leaf.endless ? kEverywhere : leaf.bounds);
    for (std::size_t i = room.size(); i-- > 1;) take(solid_.operations[i].place, room[i]);
    return room[0];
  }

  // `bounds` in the space of the step.
  void leaf(Solid::Place place, std::uint32_t step, const Region* sheets, Bounds bounds,
            bool endless = false) {
    ++solid_.operations[place.operation].operands;
    const double off = tolerance(step, bounds);
    for (std::uint32_t s = step; s != kNone; s = solid_.steps[s].outer)
      bounds = model_.placedBoundsOf(bounds, model_.store().object(solid_.steps[s].object).node);
    solid_.leaves.push_back({place, step, bounds, sheets, endless, off});
  }

  // Asked for the corners of what is at the step, at both ends of the exposure.
  double tolerance(std::uint32_t step, const Bounds& bounds) const {
    double most = 0;
    for (const double time : {exposure_.opens, exposure_.closes}) {
      const std::vector<Affine> maps = mapsFrom(step, {time, exposure_.frame});
      for (int corner = 0; corner < 8 && !maps.empty(); ++corner) {
        Vec3 point;
        for (int axis = 0; axis < 3; ++axis) {
          const double side = (corner >> axis & 1) != 0 ? bounds.high[axis] : bounds.low[axis];
          point[axis] = std::isfinite(side) ? side : 0;
        }
        Vec3 outside = point;
        for (const Affine& map : maps) outside = mapPoint(map.forward, outside);
        const double error = maxAbs(errorOfWay(maps, point, outside));
        if (std::isfinite(error)) most = std::max(most, error);
      }
    }
    return most;
  }

  // From a step outwards; none if it is nowhere then.
  std::vector<Affine> mapsFrom(std::uint32_t step, const Moment& moment) const {
    const SceneStore& store = model_.store();
    std::vector<Affine> maps;
    for (std::uint32_t s = step; s != kNone; s = solid_.steps[s].outer) {
      const NodeIndex node = store.object(solid_.steps[s].object).node;
      if (store.node(node).identity) continue;
      const std::optional<Affine> map = mapAt(store, node, moment);
      if (!map) return {};
      maps.push_back(*map);
    }
    return maps;
  }

  const Model& model_;
  const Exposure& exposure_;
  Solid solid_;
};

}  // namespace

std::size_t Solid::bytes() const {
  std::size_t total = sizeof *this + steps.capacity() * sizeof(Step) +
                      operations.capacity() * sizeof(Operation) + leaves.capacity() * sizeof(Leaf) +
                      bvh.bytes();
  for (const auto& region : own) total += region->bytes();
  return total;
}

InlineVector<ObjectIndex, 8> wayTo(const Solid& solid, const Solid::Leaf& leaf) {
  InlineVector<ObjectIndex, 8> way;
  for (std::uint32_t s = leaf.step; s != kNone; s = solid.steps[s].outer)
    way.push_back(solid.steps[s].object);
  std::reverse(way.begin(), way.end());
  return way;
}

Solid solidOf(const Model& model, const Csg& csg, const Exposure& exposure) {
  return SolidBuilder(model, exposure).build(csg);
}

}  // namespace rayshade
