// What voxel-trace and pyramid-trace tasks have in common: shading a hit, and shadow rays that are traced where they were
// spawned.
//
// At a hit the secondary rays are spawned and a shade task is told.  Shadow rays are followed as far as the voxels of this
// task go; what comes after is decided by the policy: `forward` sends them to the next voxel's task, `local` fetches the
// cells that are missing into the object cache and goes on when they have come (Reinhard & Jansen, section 5), `automatic`
// does what is expected to move fewer bytes.  All shadow rays from one hit to one area light are one bundle, the light
// pyramid: it waits as a whole, and the cells on its clip-list are asked for together.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <map>
#include <unordered_set>

#include "pvm/task_desk.h"
#include "rayshade/shading/evaluate.h"
#include "rayshade/space/clip_list.h"

namespace rayshade {

// What is known of an epoch by every task that traces.
struct TraceSetting {
  Setting setting;
  BinTree tree;
  Directory directory;
  std::uint32_t cluster = 0;
  Exposure exposure;
  DemandPolicy policy;
  std::vector<std::uint32_t> cellBytes;

  TaskId ownerOf(VoxelId voxel) const { return directory.ownerOf(voxel, cluster); }
};

// The voxels that a task holds itself.
class OwnVoxels {
 public:
  virtual ~OwnVoxels() = default;
  virtual Ground own(VoxelId voxel) const = 0;
};

class RayWorker : public GroundSource {
 public:
  // `own`: null for a task that holds no voxels.
  RayWorker(TaskDesk& desk, const OwnVoxels* own) : desk_(desk), own_(own) {}

  // A new epoch: everything that waits is dropped.  `recordBase` sets the records of this task apart from others'.
  void begin(TraceSetting setting, std::uint32_t recordBase);

  void setWeights(std::vector<std::uint32_t> weights) {
    if (weights.size() == at_.directory.shadeTasks.size()) at_.directory.shadeWeights = std::move(weights);
  }

  const TraceSetting& at() const { return at_; }
  TraceCounts& counts() { return counts_; }
  ObjectCache& cache() { return cache_; }
  const CacheCounts& shadowCounts() const { return shadowCounts_; }
  std::size_t waiting() const { return parkedCount_; }
  std::uint64_t combined() const { return combined_; }

  // A ray of this task has hit.  `queue` takes the transmitted and reflected rays.
  template <class Queue>
  void shade(const Ray& ray, const ReplyTo& to, const Hit& hit, const Model& model, Queue queue);

  void answer(const ReplyTo& to, Color color) {
    desk_.outbox.post(to.task, Answer{to.record, to.slot, color});
  }

  // Asks for a cell unless it is here or asked for already.
  void want(CellId cell);
  bool isEmpty(CellId cell) const { return at_.cellBytes[static_cast<std::size_t>(cell)] == 0; }
  bool isHere(CellId cell) const { return isEmpty(cell) || cache_.contains(cell); }
  // A cell has come; false: it was not asked for.  It stays in the cache until release(), whatever else comes in.
  bool take(CellItems&& message);
  void release(CellId cell) { cache_.unpin(cell); }

  Ground voxel(VoxelId voxel) override { return own_ == nullptr ? Ground{} : own_->own(voxel); }
  Ground cell(CellId cell) override;

 private:
  struct Pending {  // a shadow ray on its way
    ShadowRay shadow;
    std::uint32_t unit = 0;
    Slot slot = 0;
  };
  struct Bundle {  // of one light and one hit
    std::vector<Pending> rays;
    TaskId shader = kNobody;
    RecordId record = 0;
  };

  // What stopped the last shadow ray to a light point: asked first, which can't change the answer.
  struct Occluder {
    ObjectIndex object = kNone;
    std::uint32_t ground = 0;
  };

  void traceBundle(Bundle&& bundle, const LightSource& light);
  void park(Bundle&& bundle, CellId missing, const LightSource* light);
  bool fetchingPays(CellId missing, std::size_t rays) const;
  void forward(const Pending& pending, const Bundle& bundle, const LocalProgress& progress);
  void resume(Bundle&& bundle);
  void askMore();

  TaskDesk& desk_;
  const OwnVoxels* own_;
  TraceSetting at_;
  TraceCounts counts_;
  CacheCounts shadowCounts_;
  ObjectCache cache_;
  Model noModel_;
  Region nothing_;                   // of an empty cell
  std::vector<Occluder> occluders_;  // by light point

  std::uint32_t recordBase_ = 0;
  std::uint64_t serial_ = 0;                                       // of the next intersection found here
  std::unordered_map<std::uint32_t, std::vector<Bundle>> parked_;  // by the cell they wait for
  std::size_t parkedCount_ = 0;
  std::uint64_t combined_ = 0;
  std::unordered_set<std::uint32_t> asked_;   // cells on their way
  std::deque<CellId> toAsk_;                  // more than may be on their way
  std::unordered_set<std::uint32_t> queued_;  // in toAsk_
};

template <class Queue>
void RayWorker::shade(const Ray& ray, const ReplyTo& to, const Hit& hit, const Model& model, Queue queue) {
  const SurfacePoint at = evaluateSurface(model, hit, ray, at_.setting);
  Secondary spawned = spawnSecondary(ray, at, at_.setting);
  Expect expect;
  expect.record = static_cast<RecordId>(recordBase_) << 44 | (serial_++ & 0xfffffffffffu);
  expect.to = to;
  const TaskId shader = chooseShadeTask(at_.directory, expect.record);

  // Shadow rays first: those that are settled without leaving this task travel with the intersection.
  std::size_t point = 0;
  for (std::size_t l = 0; l < at_.setting.lights.size(); ++l) {
    const std::size_t end = point + static_cast<std::size_t>(pointsOf(at_.setting.lights[l]));
    Bundle bundle{{}, shader, expect.record};
    for (; point < end; ++point) {
      if (spawned.lit[point] != Lit::asked) continue;
      ++counts_.shadowRays;
      Pending pending{shadowRay(ray, at, spawned.samples[point]), 0, static_cast<Slot>(point)};
      Occluder& occluder = occluders_[point];
      pending.shadow.occluder = occluder.object;
      pending.shadow.occluderGround = occluder.ground;
      const LocalProgress progress =
          followLocally(at_.tree, *this, pending.shadow, pending.unit, at_.setting, counts_);
      occluder = {pending.shadow.occluder, pending.shadow.occluderGround};
      if (progress.state == LocalProgress::State::missing) {
        expect.pending.push_back(pending.slot);
        bundle.rays.push_back(std::move(pending));
      } else {
        expect.known.push_back(progress.state == LocalProgress::State::hit ? kBlack : pending.shadow.through);
      }
    }
    if (!bundle.rays.empty()) traceBundle(std::move(bundle), at_.setting.lights[l]);
  }
  expect.hit = describe(ray, hit.t, at, spawned, at_.setting);
  if (at_.policy.shadeAtOnce && expect.pending.empty() && !spawned.transmitted && !spawned.reflected) {
    ++combined_;
    answer(to, combine(expect.hit, gatheredFrom(expect), at_.setting, spawned.samples));
    return;
  }
  desk_.outbox.post(shader, expect);
  if (spawned.transmitted) {
    ++counts_.transmittedRays;
    queue(RayTask{std::move(*spawned.transmitted), 0, {shader, expect.record, kTransmittedSlot}});
  }
  if (spawned.reflected) {
    ++counts_.reflectedRays;
    queue(RayTask{std::move(*spawned.reflected), 0, {shader, expect.record, kReflectedSlot}});
  }
}

}  // namespace rayshade
