// The pyramid-trace task (Reinhard & Jansen, section 4, figure 4).
//
// Demand driven: it asks the host for work.  A tile of primary rays is one pyramid; its clip-list says which cells of the
// bin-tree it may touch, near to far, without any object.  The cells up to the horizon are fetched into the object cache -
// while they come, other pyramids are worked on - and then the rays are traced against them.  Behind the horizon rays go
// over to the data-parallel voxels.
//
// A camera with a lens has no common apex: then the list is the union of the walks of the rays.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/trace/tiles.h"
#include "pvm/trace/trace_unit.h"

namespace rayshade {

class PyramidTask {
 public:
  using Accepted = TypeList<Configure, Finish, Ping, Weights, PrimaryRays, CellItems>;
  static constexpr int kAhead =
      4;  // pyramids asked for at a time: some are traced while others wait for cells

  explicit PyramidTask(Link& link) : context_(link), unit_(context_, nullptr) {}

  void receive(const LinkEvent& event) { receiveEvent(*this, context_, event); }
  bool work(double until);
  void flush();
  bool finished() const { return context_.finished; }
  void noteIdle(double seconds) { context_.idleSeconds += seconds; }

  Epoch epoch() const { return context_.epoch; }
  void on(TaskId from, Configure message);
  void on(TaskId from, Finish);
  void on(TaskId from, Ping);
  void on(TaskId from, Weights message);
  void on(TaskId from, PrimaryRays message);
  void on(TaskId from, CellItems message);

 private:
  std::size_t beforeHorizon(const std::vector<CellId>& cells, std::size_t rays) const;
  void tracePyramid();
  void traceSecondaries(RayBundle& rays);
  void goOn(Ray&& ray, const ReplyTo& to);
  void finish(Tile& tile);

  TaskContext context_;
  TraceUnit unit_;
  TaskId host_ = kNobody;
  WaitingTiles tiles_;
  RayBundle secondaries_;                                        // to be traced, last in first out
  RayBundle bundle_;                                             // being traced
  std::unordered_map<std::uint32_t, RayBundle> waitingForCell_;  // secondary rays
  std::uint64_t pyramids_ = 0, pyramidRays_ = 0, forwarded_ = 0;
};

}  // namespace rayshade
