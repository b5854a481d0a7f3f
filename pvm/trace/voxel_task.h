// The voxel-trace task (Reinhard & Jansen, figure 3, left).
//
// It holds the objects that touch its voxels and traces rays through them.  A ray that leaves without a hit goes to
// the task of the next voxel; at a hit, secondary rays are spawned and a shade task is told of the intersection, so that
// it reserves a place for the colours that will come.  Rays that are waiting are taken deepest first and shadow rays
// before all: the tree of each sample is walked like a stack, which bounds what waits.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/trace/ray_queue.h"
#include "pvm/trace/trace_unit.h"

namespace rayshade {

class VoxelTask {
 public:
  using Accepted = TypeList<Forget, Items, Configure, Finish, Ping, Weights, PrimaryRays, RayTask, ShadowTask,
                            CellWanted, CellItems>;

  explicit VoxelTask(Link& link) : context_(link), unit_(context_, &share_) {}

  // The life in event_loop.h.
  void receive(const LinkEvent& event) { receiveEvent(*this, context_, event); }
  bool work(double until);
  void flush();
  bool finished() const { return context_.finished; }
  const VoxelShare& share() const { return share_; }
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

  // Samples, rays and intersections with shadow rays.
  std::uint64_t waiting() const { return samples_.waiting() + rays_.size() + shadows_.bundles(); }

 private:
  void dropWork();
  void takePrimaries();
  void traceBundle();
  void traceShadows();

  TaskContext context_;
  VoxelShare share_;
  TraceUnit unit_;
  TaskId host_ = kNobody;
  SampleQueue samples_;  // their rays are made when there is nothing deeper to do
  RayQueue rays_;
  ShadowQueue shadows_;
  RayBundle bundle_;  // being traced
  std::uint64_t cellsServed_ = 0;
};

}  // namespace rayshade
