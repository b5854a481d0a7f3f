// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/scene/object_stream.h"

#include <algorithm>
#include <utility>

#include "rayshade/scene/held_bytes.h"

namespace rayshade {
namespace {

const std::uint64_t kSurfaceBytes = encode(Surface{}).size();

// Spooled items are framed by their size.
void readItems(Spool& spool, std::uint64_t begin, std::uint64_t end,
               const std::function<void(const Item&)>& take) {
  Bytes bytes;
  for (std::uint64_t at = begin; at < end;) {
    std::uint32_t size = 0;
    spool.read(at, std::as_writable_bytes(std::span(&size, 1)));
    bytes.resize(size);
    spool.read(at + sizeof size, bytes);
    at += sizeof size + size;
    if (const auto item = decode<Item>(bytes)) take(*item);
  }
}

// Where a chain of nodes, innermost first, takes a point at a moment.  Multiplied from the outside in, like the maps of
// a SceneStore: the product of the same matrices in another order of brackets has other last bits.
std::optional<Affine> composed(const std::vector<const NodeItem*>& chain, const Moment& moment) {
  Affine map;
  for (auto f = chain.rbegin(); f != chain.rend(); ++f) {
    const std::optional<Affine> own = chainAt((*f)->node.transforms, moment);
    if (!own) return std::nullopt;
    map = then(*own, map);
    if (!isInvertible(map)) return std::nullopt;
  }
  return map;
}

}  // namespace

ObjectStream::ObjectStream(const Exposure& exposure, Consumer consumer)
    : exposure_(exposure), consumer_(std::move(consumer)) {}

void ObjectStream::surface(SurfaceId id, const Surface& surface) {
  if (number(id) * kSurfaceBytes == surfaceSpool_.size()) surfaceSpool_.append(encode(surface));
}

std::optional<Surface> ObjectStream::findSurface(SurfaceId id) {
  const std::uint64_t at = number(id) * kSurfaceBytes;
  if (at >= surfaceSpool_.size()) return std::nullopt;
  Bytes bytes(kSurfaceBytes);
  surfaceSpool_.read(at, bytes);
  return decode<Surface>(bytes);
}

void ObjectStream::note(NodeId id) { statement_.mentioned = std::max(statement_.mentioned, number(id)); }

void ObjectStream::spool(const Item& item, Spool& to) {
  scratch_.clear();
  Writer{scratch_}(std::uint32_t{0}, item);
  const auto size = static_cast<std::uint32_t>(scratch_.size() - sizeof(std::uint32_t));
  std::memcpy(scratch_.data(), &size, sizeof size);
  to.append(scratch_);
}

void ObjectStream::node(NodeId id, SceneNode node) {
  NodeItem item{id, std::move(node)};
  spool(item, statement_.spool);
  if (number(id) <= statement_.mentioned) statement_.late.emplace(number(id), std::move(item));
  note(id);
}

void ObjectStream::object(SceneObject object) {
  // The common case, a primitive at top level with neither transforms nor textures, needs no spooling.
  if (object.container == kWorld && object.node == kRootNode && statement_.spool.size() == 0 &&
      std::holds_alternative<AnyShape>(object.body)) {
    hand(object, nullptr);
    return;
  }
  note(object.node);
  if (object.container != kWorld) {
    auto [definition, isNew] = definitions_.try_emplace(number(object.container));
    if (isNew) statement_.defined.push_back(object.container);
  }
  spool(Item{std::move(object)}, statement_.spool);
}

Bounds ObjectStream::ownBounds(const SceneObject& object) const {
  auto boundsOf = [this](DefinitionId id) {
    const auto found = definitions_.find(number(id));
    return found == definitions_.end() ? Bounds{} : found->second.bounds;
  };
  if (const AnyShape* shape = std::get_if<AnyShape>(&object.body))
    return std::visit([](const auto& s) { return s.bounds(); }, *shape);
  if (const Instance* instance = std::get_if<Instance>(&object.body)) return boundsOf(instance->definition);
  return boundsOf(std::get<Csg>(object.body).operands);
}

// From the innermost node outwards.  `own` is the node that came just before the object.
std::vector<const NodeItem*> ObjectStream::nodesOf(NodeId id, const NodeItem* own) const {
  std::vector<const NodeItem*> chain;
  while (id != kRootNode) {
    const NodeItem* f = nullptr;
    if (own != nullptr && own->id == id) {
      f = own;
    } else if (const auto found = statement_.late.find(number(id)); found != statement_.late.end()) {
      f = &found->second;
    }
    if (f == nullptr || number(f->node.parent) >= number(id)) break;
    chain.push_back(f);
    id = f->node.parent;
  }
  return chain;
}

// An aggregate has a smaller number than what is in it, so a node with a larger number than all before is new.
ObjectStream::Brought ObjectStream::broughtBy(const SceneObject& object,
                                              std::span<const NodeItem* const> chain) {
  Brought brought{heldBytes(object), 0};
  for (const NodeItem* node : chain)
    if (number(node->id) > broughtNode_) brought.bytes += heldBytes(node->node);
  if (!chain.empty()) broughtNode_ = std::max(broughtNode_, number(chain.front()->id));
  DefinitionId used = kWorld;
  if (const Instance* instance = std::get_if<Instance>(&object.body)) used = instance->definition;
  if (const Csg* csg = std::get_if<Csg>(&object.body)) used = csg->operands;
  if (const auto found = definitions_.find(number(used)); used != kWorld && found != definitions_.end())
    brought.definition = std::exchange(found->second.bytes, 0);
  return brought;
}

void ObjectStream::hand(const SceneObject& object, const NodeItem* own) {
  const auto chain = nodesOf(object.node, own);
  const bool moves =
      std::any_of(chain.begin(), chain.end(), [](const NodeItem* f) { return f->node.transforms.moves(); });
  const Bounds bounds = placedBounds(
      ownBounds(object), moves, [&](const Moment& moment) { return composed(chain, moment); }, exposure_);
  const Brought brought = broughtBy(object, chain);
  if (object.container == kWorld) {
    ++objects_;
    std::vector<const NodeItem*> outermostFirst(chain.rbegin(), chain.rend());
    consumer_(object, bounds, outermostFirst, brought);
  } else {
    SpooledDefinition& definition = definitions_[number(object.container)];
    definition.bounds = join(definition.bounds, bounds);
    definition.bytes += brought.bytes + brought.definition;
  }
}

void ObjectStream::endOfStatement() {
  Statement& statement = statement_;
  if (statement.spool.size() == 0) return;
  // What definitions consist of is kept: their objects, and every node that one of those can hang on.  This comes
  // first: the consumer of an object asks for the definition that it uses, which can be of the same statement.
  if (!statement.defined.empty()) {
    const std::uint64_t begin = definitionSpool_.size();
    readItems(statement.spool, 0, statement.spool.size(), [&](const Item& item) {
      const SceneObject* object = std::get_if<SceneObject>(&item);
      if (object == nullptr || object->container != kWorld) spool(item, definitionSpool_);
    });
    for (DefinitionId id : statement.defined)
      definitions_[number(id)].pieces.emplace_back(begin, definitionSpool_.size() - begin);
  }
  // The members of a definition come before its first use, so one pass in order knows the bounds of what it meets.
  NodeItem own;
  bool ownIsSet = false;
  readItems(statement.spool, 0, statement.spool.size(), [&](const Item& item) {
    if (const NodeItem* f = std::get_if<NodeItem>(&item)) {
      own = *f;
      ownIsSet = true;
    } else if (const SceneObject* object = std::get_if<SceneObject>(&item)) {
      hand(*object, ownIsSet ? &own : nullptr);
    }
  });
  statement.spool.clear();
  statement.late.clear();
  statement.defined.clear();
}

void ObjectStream::readDefinition(DefinitionId id, const std::function<void(const Item&)>& take) {
  const auto found = definitions_.find(number(id));
  if (found == definitions_.end()) return;
  for (const auto& [offset, size] : found->second.pieces) {
    readItems(definitionSpool_, offset, offset + size, [&](const Item& item) {
      const SceneObject* object = std::get_if<SceneObject>(&item);
      if (object == nullptr || object->container == id) take(item);
    });
  }
}

}  // namespace rayshade
