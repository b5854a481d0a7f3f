// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/scene/held_bytes.h"

#include "rayshade/scene/store.h"

namespace rayshade {
namespace {

constexpr std::uint64_t kHeader = 16;  // of a block of memory
constexpr std::uint64_t kAccelerator =
    72;  // of an object: target, leaf, its part of the nodes; by measurement

template <class T>
std::uint64_t bytesOf(const std::vector<T>& list) {
  return list.capacity() == 0 ? 0 : list.capacity() * sizeof(T) + kHeader;
}

// Overloads for the shapes that hold anything.
template <class Shape>
std::uint64_t outside(const Shape&) {
  return 0;
}
std::uint64_t outside(const Polygon& p) {
  return bytesOf(p.corners) + (p.outline ? p.outline->bytes() + kHeader : 0);
}
std::uint64_t outside(const Blob& b) { return bytesOf(b.balls); }
std::uint64_t outside(const HeightField& h) {
  if (!h.heights) return 0;
  std::uint64_t bytes = sizeof *h.heights + bytesOf(h.heights->values);
  for (const auto& level : h.heights->ranges) bytes += bytesOf(level);
  return bytes;
}

std::uint64_t bytesOf(const TransformChain& chain) {
  std::uint64_t bytes = bytesOf(chain.steps);
  for (const auto& step : chain.steps)
    if (const MovingStep* moving = std::get_if<MovingStep>(&step)) bytes += bytesOf(moving->arguments);
  return bytes;
}

}  // namespace

std::uint64_t bytesOutside(const AnyShape& shape) {
  return std::visit([](const auto& s) { return outside(s); }, shape);
}

std::uint64_t bytesOutside(const AllShapes::Vectors& shapes) {
  std::uint64_t bytes = 0;
  std::apply(
      [&](const auto&... list) {
        const auto add = [&](const auto& of) {
          for (const auto& shape : of) bytes += outside(shape);
        };
        (add(list), ...);
      },
      shapes);
  return bytes;
}

std::uint64_t imageBytes(const SceneNode& node) {
  std::uint64_t bytes = 0;
  for (const PlacedTexture& placed : node.textures)
    if (const ImageTexture* texture = std::get_if<ImageTexture>(&placed.texture); texture && texture->image)
      bytes += texture->image->bytes();
  return bytes;
}

std::uint64_t bytesOutside(const SceneNode& node) {
  std::uint64_t bytes = bytesOf(node.transforms) + bytesOf(node.textures);
  for (const PlacedTexture& placed : node.textures) bytes += bytesOf(placed.transforms);
  return bytes;
}

std::uint64_t heldBytes(const SceneObject& object) {
  const std::uint64_t placed = sizeof(PlacedObject) + sizeof(ObjectIndex) + kAccelerator;
  const AnyShape* shape = std::get_if<AnyShape>(&object.body);
  if (shape == nullptr) return placed + sizeof(Instance);
  return placed + std::visit([](const auto& s) { return sizeof s + outside(s); }, *shape);
}

std::uint64_t heldBytes(const SceneNode& node) {
  return sizeof(PlacedNode) + kTableEntryBytes + bytesOutside(node);
}

}  // namespace rayshade
