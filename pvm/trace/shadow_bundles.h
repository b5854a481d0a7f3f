// Shadow rays that need what is not local (Reinhard & Jansen, section 5).
//
// What comes after the own voxels is decided by the policy: `forward` sends the rays to the task of the next voxel; else missing
// cells are fetched into the object cache if that pays (cell_fetcher.h) and the rays go on when they have come.  `local`: it pays as
// long as there is room.  All shadow rays from one hit to one area light are one bundle, the light pyramid: it waits as a whole, and the
// cells on its clip-list are asked for together.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <unordered_map>

#include "pvm/trace/cell_fetcher.h"
#include "pvm/trace/task_space.h"
#include "rayshade/trace/shade_hits.h"

namespace rayshade {

// Shadow rays of one intersection that go on elsewhere: one message for each task.
class ShadowBatch {
 public:
  void begin(const ShadowHead& head) {
    head_ = head;
    used_ = 0;
  }
  void add(TaskId to, const ShadowTravel& travel) {
    std::size_t i = 0;
    while (i < used_ && open_[i].to != to) ++i;
    if (i == used_) {
      if (used_ == open_.size()) open_.emplace_back();
      ++used_;
      open_[i].to = to;
      open_[i].task.head = head_;
      open_[i].task.rays.clear();
    }
    open_[i].task.rays.push_back(travel);
  }
  void post(Outbox& outbox) {
    for (std::size_t i = 0; i < used_; ++i) outbox.post(open_[i].to, open_[i].task);
    used_ = 0;
  }

 private:
  struct Open {
    TaskId to = kNobody;
    ShadowTask task;
  };
  ShadowHead head_;
  std::vector<Open> open_;  // the first `used_` of them
  std::size_t used_ = 0;
};

class ShadowBundles {
 public:
  ShadowBundles(TaskContext& context, const EpochSettings& at, TaskSpace& space, CellFetcher& cells,
                TraceCounts& counts)
      : context_(context), at_(at), space_(space), cells_(cells), counts_(counts) {}

  // A new epoch: whatever waits is dropped.
  void begin() {
    parked_.clear();
    waiting_ = 0;
  }

  // Shadow rays of one intersection that cannot be resolved here: to the tasks that can, or into waiting until it can.
  void sendOn(const ShadowHead& head, std::span<PendingShadow> pending);
  // Shadow rays of one intersection that have come from elsewhere.
  struct Visitors {
    ShadowHead head;
    std::span<const ShadowTravel> rays;
  };
  // Takes them through what is local, and sends on or answers each.
  void follow(std::span<const Visitors> visitors);
  // A cell is here: what waits for it goes on.
  void resume(CellId cell);

  std::size_t waiting() const { return waiting_; }

 private:
  struct Parked {
    ShadowRay shadow;
    Slot slot = 0;
    NextBlock next{};  // what it misses; before that all has been looked at
  };
  struct Bundle {  // of one light and one hit
    ShadowHead head;
    std::vector<Parked> rays;
  };
  void sendOn(std::span<PendingShadow> pending, const ShadowHead& head, const LightSource& light);
  bool waitsFor(CellId missing, std::size_t rays);
  void park(Bundle&& bundle, CellId missing, const LightSource* light);
  void goOn(Bundle&& bundle);

  TaskContext& context_;
  const EpochSettings& at_;
  TaskSpace& space_;
  CellFetcher& cells_;
  TraceCounts& counts_;
  std::unordered_map<std::uint32_t, std::vector<Bundle>> parked_;  // by the cell they wait for
  std::size_t waiting_ = 0;                                        // bundles
  // Room that is used again.
  ShadowBatch batch_;
  LightAnswers answers_;
  std::vector<OpenShadow> open_, visitorsOpen_;
  std::vector<Color> arriving_;
};

}  // namespace rayshade
