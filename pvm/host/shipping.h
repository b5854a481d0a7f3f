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

  // Sends to the task with a number; returns when another batch may follow (or must give up: then it throws).
  using Send = std::function<void(std::uint32_t task, Items&& batch)>;

  // Sees to it that the task has an image.
  using BringImage = std::function<void(std::uint32_t task, const Image& image)>;

  // `targets`: which of the directory's voxel tasks are shipped to.  What lies in each cell of the tree is noted in
  // `configuration`.
  Shipping(Configure& configuration, std::set<std::uint32_t> targets, Send send, BringImage bringImage);

  SceneSink& sink() { return stream_; }  // for the whole scene
  void finish();                         // sends what is left

 private:
  struct Parcel {  // for one task
    Items batch;
    std::size_t bytes = 0;
    std::set<std::uint32_t> surfaces, nodes, definitions;  // that it has
  };

  void ship(const SceneObject& object, const Bounds& bounds, std::span<const NodeItem* const> nodes);
  void add(std::uint32_t task, Item item);
  void addSurface(std::uint32_t task, SurfaceId id);
  void addNode(std::uint32_t task, const NodeItem& node);
  void addNeeds(std::uint32_t task, const SceneObject& object);

  Configure& configuration_;
  std::set<std::uint32_t> targets_;
  Send send_;
  BringImage bringImage_;
  ObjectStream stream_;
  std::unordered_map<std::uint32_t, Parcel> parcels_;
};

}  // namespace rayshade
