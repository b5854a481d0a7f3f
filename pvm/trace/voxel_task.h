// The voxel-trace task (Reinhard & Jansen, figure 3, left).
//
// It holds the objects that touch its voxels and traces rays through them.  A ray that leaves without a hit goes to
// the task of the next voxel; at a hit, secondary rays are spawned and a shade task is told of the intersection, so that
// it reserves a place for the colours that will come.  Rays that are waiting are taken deepest first and shadow rays
// before all: the tree of each sample is walked like a stack, which bounds what waits.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "pvm/trace/ray_worker.h"

namespace rayshade {

class VoxelTask : public VoxelSource, public OwnVoxels {
 public:
  static constexpr double kHoldSeconds = 0;  // rays are waited for
  using Accepted = TypeList<Forget, Items, Configure, Finish, Ping, Weights, PrimaryRays, RayTask, ShadowTask,
                            CellWanted, CellItems>;

  explicit VoxelTask(Link& link) : context_(link), worker_(context_, this) {}

  // The life in event_loop.h.
  void receive(const LinkEvent& event) { receiveEvent(*this, context_, event); }
  bool work(double until);
  void flush() { worker_.flush(); }
  bool finished() const { return context_.finished; }
  void noteIdle(double seconds) { context_.idleSeconds += seconds; }

  Epoch epoch() const { return context_.epoch; }
  void on(TaskId from, Forget);
  void on(TaskId from, Items message);
  void on(TaskId from, Configure message);
  void on(TaskId from, Finish);
  void on(TaskId from, Ping);
  void on(TaskId from, PrimaryRays&& work);
  void on(TaskId from, RayTask&& task);
  void on(TaskId from, const ShadowTask& task);
  void on(TaskId from, Weights message);
  void on(TaskId from, CellWanted message);
  void on(TaskId from, CellItems message);

  const Region* find(VoxelId voxel) const override;
  bool mayMeet(VoxelId voxel, const Ray& ray, double tMin, double tMax) const override {
    return worker_.at().voxelBounds.mayMeet(voxel, ray.origin, ray.direction, tMin, tMax);
  }
  RegionRef own(VoxelId voxel) const override;
  std::uint64_t waiting() const { return waitingSamples_ + waitingRays_ + shadows_.size(); }

 private:
  void buildRegions();
  struct Primaries {
    PrimaryRays work;
    std::size_t next = 0;  // sample
  };
  struct Shadows {
    ShadowHead head;
    std::uint32_t rays = 0;  // of those in shadowRays_
  };

  void dropWork();
  void traceShadows();
  void takeDeepest();
  void takePrimaries();
  void trace(std::span<RayTask> tasks);  // kBundleSize of them at most
  void queue(RayTask&& task);

  TaskContext context_;
  RayWorker worker_;
  std::uint32_t number_ = 0;  // in its cluster

  std::optional<Model> model_{std::in_place};
  bool itemsAreNew_ = false;
  std::vector<std::unique_ptr<Region>> regions_;  // by voxel; null: not mine
  std::uint64_t owned_ = 0;
  std::map<std::uint32_t, std::vector<ObjectIndex>> cellObjects_;  // made when somebody asks for a cell
  std::uint64_t cellsServed_ = 0;

  TaskId host_ = kNobody;
  FrameRequest request_;
  std::deque<Primaries> primaries_;  // their rays are made when there is nothing deeper to do
  std::uint64_t waitingSamples_ = 0;
  std::vector<std::vector<RayTask>> raysByDepth_;
  std::uint64_t waitingRays_ = 0;
  std::vector<Shadows> shadows_;          // last in, first out
  std::vector<ShadowTravel> shadowRays_;  // of all of them, in the same order
  std::vector<RayTask> batch_;            // being traced
  std::vector<RayWorker::Visitors> visitors_;
};

}  // namespace rayshade
