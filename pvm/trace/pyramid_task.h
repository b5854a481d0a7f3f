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

#include "pvm/trace/ray_worker.h"

namespace rayshade {

class PyramidTask : public GroundSource {
 public:
  static constexpr double kHoldSeconds = 0;  // pyramids are waited for
  using Accepted = TypeList<Configure, Finish, Ping, Weights, PrimaryRays, CellItems>;
  static constexpr int kAhead =
      4;  // pyramids asked for at a time: some are traced while others wait for cells

  explicit PyramidTask(Link& link) : context_(link), worker_(context_, nullptr) {}

  void receive(const LinkEvent& event) { receiveEvent(*this, context_, event); }
  bool work(double until);
  void flush() { worker_.flush(); }
  bool finished() const { return context_.finished; }
  void noteIdle(double seconds) { context_.idleSeconds += seconds; }

  Epoch epoch() const { return context_.epoch; }
  void on(TaskId from, Configure message);
  void on(TaskId from, Finish);
  void on(TaskId from, Ping);
  void on(TaskId from, Weights message);
  void on(TaskId from, PrimaryRays message);
  void on(TaskId from, CellItems message);

  // For primary rays: what is on the list of their pyramid is here.
  RegionRef voxel(VoxelId) override { return {}; }
  RegionRef cell(CellId cell) override;
  bool mayMeet(VoxelId voxel, const Ray& ray, double tMin, double tMax) override {
    return worker_.mayMeet(voxel, ray, tMin, tMax);
  }

 private:
  struct Tile {
    RecordId firstRecord = 0;
    std::vector<Ray> rays;
    std::size_t next = 0;       // ray to be traced
    std::vector<CellId> cells;  // up to the horizon, without empty ones
    std::size_t missing = 0;    // of those, not here yet
  };
  struct WaitingRay {  // a secondary ray that is traced here
    RayTask task;
    std::uint32_t unit = 0;
  };

  std::vector<CellId> cellsOf(const std::vector<Ray>& rays,
                              const std::vector<SamplePosition>& positions) const;
  std::size_t beforeHorizon(const std::vector<CellId>& cells, std::size_t rays) const;
  template <class Alone>
  void trace(std::span<RayTask> tasks, Alone alone);
  void shade(std::span<const FoundHit> hits);
  void followToHorizon(RayTask&& task);
  void follow(WaitingRay&& waiting);
  void conclude(const RayTask& task, const LocalProgress& progress);
  void forward(RayTask task);
  void finish(Tile& tile);

  TaskContext context_;
  RayWorker worker_;
  TaskId host_ = kNobody;
  FrameRequest request_;
  Model noModel_;
  Region nothing_;
  std::list<Tile> tiles_;                                                                   // all of them
  std::deque<std::list<Tile>::iterator> ready_;                                             // with all cells
  std::unordered_map<std::uint32_t, std::vector<std::list<Tile>::iterator>> waitingTiles_;  // by cell
  std::vector<RayTask> secondaries_;                                   // to be traced, last in first out
  std::vector<RayTask> batch_;                                         // being traced
  std::unordered_map<std::uint32_t, std::vector<WaitingRay>> parked_;  // by cell
  std::uint64_t pyramids_ = 0, pyramidRays_ = 0, forwarded_ = 0;
};

}  // namespace rayshade
