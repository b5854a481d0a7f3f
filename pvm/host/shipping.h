// Streams the model to the tasks: the host never holds it.
//
// The scene is read once more; every object goes to the tasks whose voxels its bounds touch, with the surfaces, nodes and
// definitions that it needs and the task has not got.  At most kBatches unanswered batches per task are on their way, so
// a slow task holds up the reading instead of filling buffers.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <set>

#include "pvm/messages/outbox.h"
#include "rayshade/scene/object_stream.h"

namespace rayshade {

class Shipping {
 public:
  static constexpr std::size_t kBatchBytes = 64 * 1024;
  static constexpr int kBatches = 4;
  static constexpr std::size_t kRemembered = 4096;  // surfaces, and nodes, that a task is known to have

  // Sends to the task with a number; `waitForCredit` returns when that task has answered a batch (or must give up: then
  // it throws).
  using Send = std::function<void(std::uint32_t task, Items&& batch)>;

  // `targets`: which of the directory's voxel tasks are shipped to.
  Shipping(ObjectStream& stream, const BinTree& tree, const Directory& directory,
           std::set<std::uint32_t> targets, Send send);

  // What an object takes on the wire, without what it refers to.
  static std::size_t bytesOf(const SceneObject& object) { return encode(object).size(); }

  void object(const SceneObject& object, const Bounds& bounds, std::span<const NodeItem* const> nodes);
  void finish();  // sends what is left

  std::uint64_t shipped() const { return shipped_; }  // objects, counted once per task

 private:
  struct Parcel {  // for one task
    Items batch;
    std::size_t bytes = 0;
    std::set<std::uint32_t> surfaces, nodes, definitions;  // that it has
  };

  void add(std::uint32_t task, Item item);
  void addSurface(std::uint32_t task, SurfaceId id);
  void addNeeds(std::uint32_t task, const SceneObject& object);
  void addFrame(std::uint32_t task, const NodeItem& node);

  ObjectStream& stream_;
  const BinTree& tree_;
  const Directory& directory_;
  std::set<std::uint32_t> targets_;
  Send send_;
  std::unordered_map<std::uint32_t, Parcel> parcels_;
  std::vector<VoxelId> touched_;
  std::uint64_t shipped_ = 0;
};

}  // namespace rayshade
