// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/scene/store.h"

#include <algorithm>

#include "rayshade/scene/held_bytes.h"

namespace rayshade {
namespace {

// Grows by a quarter: what is copied while a list grows is there twice.
template <class T>
T& append(std::vector<T>& list, T item) {
  if (list.size() == list.capacity()) list.reserve(list.size() + list.size() / 4 + 16);
  return list.emplace_back(std::move(item));
}

// Shapes without what they hold outside of themselves.
template <class Vectors>
std::size_t bytesOf(const Vectors& vectors) {
  return std::apply(
      [](const auto&... list) {
        return ((list.capacity() * sizeof(typename std::decay_t<decltype(list)>::value_type)) + ... + 0);
      },
      vectors);
}

// The image of a box, padded: so that whoever meets its content by the inverse map, which may be a little off, meets it inside.
Bounds paddedImage(const Affine& map, const Bounds& own) {
  const Bounds image = mapBounds(map, own), usual = padded(image);
  if (image.empty() || !own.finite()) return usual;
  const Vec3 reach{std::max(std::abs(own.low.x), std::abs(own.high.x)),
                   std::max(std::abs(own.low.y), std::abs(own.high.y)),
                   std::max(std::abs(own.low.z), std::abs(own.high.z))};
  Matrix missed = product(map.forward, map.inverse);  // minus the identity: what out and in again misses by
  missed.x.x -= 1;
  missed.y.y -= 1;
  missed.z.z -= 1;
  const Matrix out = absolute(map.forward), in = absolute(map.inverse);
  const Vec3 outside = mapPoint(out, reach);
  const Vec3 inside = mapPoint(absolute(missed), reach) + 2 * kRounding * mapPoint(in, outside);
  const Vec3 margin = 2 * mapVector(out, inside);
  return join(usual, {image.low - margin, image.high + margin});
}

}  // namespace

void StoredSurfaces::add(SurfaceId id, const Surface& surface) {
  if (!index_.try_emplace(number(id), static_cast<SurfaceIndex>(surfaces_.size())).second) return;
  surfaces_.push_back(surface);
  ids_.push_back(id);
  anyTransparent_ = anyTransparent_ || surface.transparency >= kNegligible;
}

SurfaceIndex StoredSurfaces::find(SurfaceId id) const {
  const auto found = index_.find(number(id));
  return found == index_.end() ? kNone : found->second;
}

StoredNodes::StoredNodes() {
  nodes_.emplace_back();  // the root
  index_[number(kRootNode)] = 0;
}

std::optional<NodeIndex> StoredNodes::find(NodeId id) const {
  const auto found = index_.find(number(id));
  return found == index_.end() ? std::nullopt : std::optional(found->second);
}

std::size_t StoredNodes::add(NodeId id, SceneNode node) {
  if (!index_.try_emplace(number(id), static_cast<NodeIndex>(nodes_.size())).second) return 0;
  // An aggregate gets its number before its members do: a parent with a larger number would be a circle.
  const bool circle = number(node.parent) >= number(id);
  if (circle) node.parent = kRootNode;
  PlacedNode& added = append(nodes_, {});
  added.id = id;
  added.node = std::move(node);
  added.parent = kNone;  // until place()
  return circle;
}

std::size_t StoredNodes::place() {
  std::size_t mended = 0;
  for (PlacedNode& node : nodes_)
    if (node.parent == kNone) mended += place(node);
  nodes_.shrink_to_fit();
  return mended;
}

// Composes the map of a node from its own and its parent's; parents first.
std::size_t StoredNodes::place(PlacedNode& node) {
  std::size_t mended = 0;
  std::vector<PlacedNode*> pending;
  for (PlacedNode* f = &node; f->parent == kNone;) {
    const std::optional<NodeIndex> parent = find(f->node.parent);
    pending.push_back(f);
    if (!parent) ++mended;
    f->parent = parent.value_or(0);
    f = &nodes_[f->parent];
  }
  for (; !pending.empty(); pending.pop_back()) {
    PlacedNode& f = *pending.back();
    const PlacedNode& parent = nodes_[f.parent];
    f.moves = parent.moves || f.node.transforms.moves();
    if (!f.moves) {
      const std::optional<Affine> own = chainAt(f.node.transforms, {});
      if (own) f.toContainer = then(*own, parent.toContainer);
      f.nowhere = parent.nowhere || !own || !isInvertible(f.toContainer);
      mended += f.nowhere && !parent.nowhere;
    }
    f.identity = !f.moves && !f.nowhere && isIdentity(f.toContainer);
    f.textured = parent.textured || !f.node.textures.empty();
  }
  return mended;
}

void SceneStore::object(SceneObject object) {
  PlacedObject placed;
  placed.id = object.id;
  if (AnyShape* shape = std::get_if<AnyShape>(&object.body)) {
    placed.kind = BodyKind{static_cast<std::uint8_t>(shape->index())};
    std::visit(
        [&](auto& s) {
          auto& list = std::get<std::vector<std::decay_t<decltype(s)>>>(shapes_);
          placed.body = static_cast<std::uint32_t>(list.size());
          append(list, std::move(s));
        },
        *shape);
  } else if (const Instance* instance = std::get_if<Instance>(&object.body)) {
    placed.kind = kInstanceKind;
    placed.body = static_cast<std::uint32_t>(instances_.size());
    instances_.push_back(*instance);
  } else {
    placed.kind = kCsgKind;
    placed.body = static_cast<std::uint32_t>(csgs_.size());
    csgs_.push_back(std::get<Csg>(object.body));
  }
  auto [members, isNew] = members_.try_emplace(number(object.container));
  if (isNew) definitions_.push_back(object.container);
  append(members->second, static_cast<ObjectIndex>(objects_.size()));
  append(objects_, placed);
  append(unplaced_, {object.node, object.surface});
}

void SceneStore::prepare() {
  leftOut_ += nodes_.place();
  const std::size_t placed = objects_.size() - unplaced_.size();
  for (std::size_t i = 0; i < unplaced_.size(); ++i) place(objects_[placed + i], unplaced_[i]);
  std::vector<Unplaced>().swap(unplaced_);
  objects_.shrink_to_fit();
  std::apply([](auto&... list) { (list.shrink_to_fit(), ...); }, shapes_);
  for (auto& [id, list] : members_) list.shrink_to_fit();
}

void SceneStore::place(PlacedObject& object, const Unplaced& where) {
  const std::optional<NodeIndex> node = nodes_.find(where.node);
  if (!node) ++leftOut_;
  object.node = node.value_or(0);
  // The innermost surface: the object's own, else that of the nodes around it, inside out.
  SurfaceId bound = where.surface;
  for (NodeIndex f = object.node; bound == kNoSurface && f != 0; f = nodes_[f].parent)
    bound = nodes_[f].node.surface;
  object.surface = surfaces_.find(bound);
  if (bound != kNoSurface && object.surface == kNone) ++leftOut_;
}

std::span<const ObjectIndex> SceneStore::objectsOf(DefinitionId definition) const {
  const auto found = members_.find(number(definition));
  if (found == members_.end()) return {};
  return found->second;
}

std::vector<DefinitionId> SceneStore::definitions() const {
  // What uses a definition comes after the last member of it, so sorted by their last members inner ones are first.
  std::vector<DefinitionId> sorted = definitions_;
  std::sort(sorted.begin(), sorted.end(), [this](DefinitionId a, DefinitionId b) {
    return members_.at(number(a)).back() < members_.at(number(b)).back();
  });
  return sorted;
}

std::size_t StoredNodes::bytes() const {
  std::size_t total = nodes_.capacity() * sizeof(PlacedNode) + index_.size() * kTableEntryBytes;
  for (const PlacedNode& node : nodes_) total += bytesOutside(node.node);
  return total;
}

std::size_t SceneStore::bytes() const {
  std::size_t total = objects_.capacity() * sizeof(PlacedObject) + nodes_.bytes() + surfaces_.bytes() +
                      bytesOf(shapes_) + bytesOutside(shapes_);
  for (const auto& [id, list] : members_) total += list.capacity() * sizeof(ObjectIndex);
  return total;
}

Bounds placedBounds(const Bounds& own, bool moves,
                    const std::function<std::optional<Affine>(const Moment&)>& mapAtMoment,
                    const Exposure& exposure) {
  if (!moves) {
    const std::optional<Affine> map = mapAtMoment({});
    if (!map) return {};
    return isIdentity(*map) ? padded(own) : paddedImage(*map, own);
  }
  // The union over many moments, enlarged by the largest step between two of them, so that what happens in between
  // stays inside.  differs from rayshade4: which takes moments by chance and may clip.
  constexpr int kMoments = 64;
  Bounds all, previous;
  double step = 0;
  for (int i = 0; i <= kMoments; ++i) {
    const double time = exposure.opens + (exposure.closes - exposure.opens) * i / kMoments;
    const std::optional<Affine> map = mapAtMoment({time, exposure.frame});
    const Bounds now = map ? paddedImage(*map, own) : Bounds{};
    if (i > 0 && now.finite() && previous.finite())
      step = std::max({step, maxAbs(now.low - previous.low), maxAbs(now.high - previous.high)});
    all = join(all, now);
    previous = now;
    if (exposure.closes == exposure.opens) break;
  }
  const Vec3 margin{step, step, step};
  return padded({all.low - margin, all.high + margin});
}

std::optional<Affine> mapAt(const SceneStore& store, NodeIndex index, const Moment& moment) {
  const PlacedNode& node = store.node(index);
  if (node.nowhere) return std::nullopt;
  if (!node.moves) return node.toContainer;
  const std::optional<Affine> own = chainAt(node.node.transforms, moment);
  const std::optional<Affine> outer = mapAt(store, node.parent, moment);
  if (!own || !outer) return std::nullopt;
  const Affine map = then(*own, *outer);
  return isInvertible(map) ? std::optional(map) : std::nullopt;
}

}  // namespace rayshade
