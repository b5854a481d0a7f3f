// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/host/shipping.h"

#include <algorithm>

#include "rayshade/space/voxel_bounds.h"

namespace rayshade {
namespace {

std::size_t sizeOf(const Item& item) { return encode(item).size(); }

void noteCells(const SceneObject& object, const Bounds& bounds, Configure& configuration) {
  std::vector<CellId> cells;
  cellsTouching(configuration.tree, bounds, cells);
  const auto bytes = static_cast<std::uint32_t>(encode(object).size());
  for (CellId cell : cells) {
    const auto at = static_cast<std::size_t>(cell);
    configuration.cellBytes[at] += bytes;
    Bounds& box = configuration.cellBounds[at];
    box = join(box, boundsInCell(bounds, configuration.tree, cell));
  }
}

// The voxel tasks that get an object, by number over all clusters; no task twice.
std::vector<std::uint32_t> tasksTouching(const Bounds& bounds, const Configure& configuration,
                                         const std::set<std::uint32_t>& targets) {
  const Directory& directory = configuration.directory;
  std::vector<VoxelId> voxels;
  voxelsTouching(configuration.tree, bounds, voxels);
  std::vector<std::uint32_t> tasks;
  for (VoxelId voxel : voxels) {
    for (std::uint32_t cluster = 0; cluster < directory.clusters; ++cluster) {
      const std::uint32_t task =
          cluster * directory.tasksPerCluster() + directory.voxels[static_cast<std::size_t>(voxel)];
      if (targets.contains(task) && std::find(tasks.begin(), tasks.end(), task) == tasks.end())
        tasks.push_back(task);
    }
  }
  return tasks;
}

}  // namespace

Shipping::Shipping(Configure& configuration, std::set<std::uint32_t> targets, Send send,
                   BringImage bringImage)
    : configuration_(configuration),
      targets_(std::move(targets)),
      send_(std::move(send)),
      bringImage_(std::move(bringImage)),
      stream_(configuration.exposure,
              [this](const SceneObject& object, const Bounds& bounds, std::span<const NodeItem* const> nodes,
                     const ObjectStream::Brought&) { ship(object, bounds, nodes); }) {
  configuration.cellBytes.assign(cellCount(configuration.tree), 0);
  configuration.cellBounds.assign(cellCount(configuration.tree), Bounds{});
}

void Shipping::add(std::uint32_t task, Item item) {
  Parcel& parcel = parcels_[task];
  parcel.bytes += sizeOf(item);
  parcel.batch.items.push_back(std::move(item));
  if (parcel.bytes < kBatchBytes) return;
  send_(task, std::move(parcel.batch));
  parcel.batch.items.clear();
  parcel.bytes = 0;
}

void Shipping::addSurface(std::uint32_t task, SurfaceId id) {
  std::set<std::uint32_t>& sent = parcels_[task].surfaces;
  if (sent.size() >= kRemembered) sent.clear();
  if (id == kNoSurface || !sent.insert(number(id)).second) return;
  if (const auto surface = stream_.findSurface(id)) add(task, SurfaceItem{id, *surface});
}

void Shipping::addNode(std::uint32_t task, const NodeItem& node) {
  // Sending a node again does no harm; remembering every node of a large scene would.
  std::set<std::uint32_t>& sent = parcels_[task].nodes;
  if (sent.size() >= kRemembered) sent.clear();
  if (!sent.insert(number(node.id)).second) return;
  addSurface(task, node.node.surface);
  for (const PlacedTexture& placed : node.node.textures)
    if (const ImageTexture* texture = std::get_if<ImageTexture>(&placed.texture))
      bringImage_(task, *texture->image);
  add(task, node);
}

// What an object refers to: its surface and, all the way down, its definition.
void Shipping::addNeeds(std::uint32_t task, const SceneObject& object) {
  addSurface(task, object.surface);
  DefinitionId definition = kWorld;
  if (const Instance* instance = std::get_if<Instance>(&object.body)) definition = instance->definition;
  if (const Csg* csg = std::get_if<Csg>(&object.body)) definition = csg->operands;
  if (definition == kWorld || !parcels_[task].definitions.insert(number(definition)).second) return;
  stream_.readDefinition(definition, [&](const Item& item) {
    if (const NodeItem* node = std::get_if<NodeItem>(&item)) addNode(task, *node);
    if (const SceneObject* inside = std::get_if<SceneObject>(&item)) {
      addNeeds(task, *inside);
      add(task, *inside);
    }
  });
}

void Shipping::ship(const SceneObject& object, const Bounds& bounds, std::span<const NodeItem* const> nodes) {
  noteCells(object, bounds, configuration_);
  for (std::uint32_t task : tasksTouching(bounds, configuration_, targets_)) {
    for (const NodeItem* node : nodes) addNode(task, *node);
    addNeeds(task, object);
    add(task, object);
  }
}

void Shipping::finish() {
  for (auto& [task, parcel] : parcels_) {
    if (parcel.batch.items.empty()) continue;
    send_(task, std::move(parcel.batch));
    parcel.batch.items.clear();
  }
}

}  // namespace rayshade
