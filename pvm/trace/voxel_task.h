// The voxel-trace task (Reinhard & Jansen, figure 3, left).
//
// It holds the objects that touch its voxels and traces rays through them.  A ray that leaves without a hit goes to
// the task of the next voxel; at a hit, secondary rays are spawned and a shade task is told of the intersection, so that
// it reserves a place for the colours that will come.  Rays that are waiting are taken deepest first and shadow rays
// before all: the tree of each sample is walked like a stack, which bounds what waits.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/trace/cell_holders.h"
#include "pvm/trace/ray_queue.h"
#include "pvm/trace/tile_jobs.h"
#include "pvm/trace/trace_unit.h"

namespace rayshade {

class VoxelTask {
 public:
  using Accepted = TypeList<Forget, Items, Configure, Finish, Ping, Weights, PrimaryRays, TileWork, RayTask,
                            ShadowTask, CellWanted, CellItems, Answer, ImagePlace, ImagePiece, Observe>;

  explicit VoxelTask(Link& link)
      : context_(link), unit_(context_, &share_), jobs_(context_, unit_.at, unit_.space) {}

  // The life in event_loop.h.
  void receive(const LinkEvent& event) { receiveEvent(*this, context_, event); }
  bool work(double until);
  void flush();
  bool finished() const { return context_.finished; }
  const VoxelShare& share() const { return share_; }
  void noteIdle(double seconds) { context_.noteIdle(seconds, waiting()); }

  Report counted() const;  // so far
  std::uint64_t heldBytes() const { return share_.bytes() + unit_.cache.counts().peakBytes; }

  Epoch epoch() const { return context_.epoch; }
  void on(TaskId from, Forget);
  void on(TaskId from, Items message);
  void on(TaskId from, Configure message);
  void on(TaskId from, Finish);
  void on(TaskId from, Ping);
  void on(TaskId, const Observe& message) { context_.observe(message); }
  void on(TaskId, PrimaryRays&& work);
  void on(TaskId from, TileWork message);
  void on(TaskId from, const Answer& message);
  void on(TaskId from, RayTask&& task);
  void on(TaskId from, const ShadowTask& task);
  void on(TaskId from, Weights message);
  void on(TaskId from, CellWanted message);
  void on(TaskId from, CellItems message);
  void on(TaskId from, const ImagePlace& message) { unit_.images.take(from, message, context_); }
  void on(TaskId from, const ImagePiece& message) { unit_.images.take(from, message, context_); }

  // Samples, rays, intersections with shadow rays, tiles.
  std::uint64_t waiting() const {
    return samples_.waiting() + rays_.size() + shadows_.bundles() + unit_.tiles.size() + jobs_.left();
  }

 private:
  void dropWork();
  void takePrimaries();
  bool traceSome();
  void traceBundle();
  void queue(Ray&& ray, const ReplyTo& to);
  void traceShadows();

  TaskContext context_;
  VoxelShare share_;
  TraceUnit unit_;
  TileJobs jobs_;  // with several threads, if all that there is to be met is here
  TaskId host_ = kNobody;
  bool takesTiles_ = false, onlyTracer_ = false;  // only voxel-trace tasks trace
  SampleQueue samples_;                           // their rays are made when there is nothing deeper to do
  RayQueue rays_;
  ShadowQueue shadows_;
  RayBundle bundle_;     // being traced
  CellHolders holders_;  // of cells of this task
};

}  // namespace rayshade
