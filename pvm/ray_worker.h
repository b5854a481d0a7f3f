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
#include "rayshade/space/contents.h"

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
  Contents contents;

  TaskId ownerOf(VoxelId voxel) const { return directory.ownerOf(voxel, cluster); }
};

// The voxels that a task holds itself.
class OwnVoxels {
 public:
  virtual ~OwnVoxels() = default;
  virtual Ground own(VoxelId voxel) const = 0;
};

// Shadow rays of one intersection that go on elsewhere: one message for each task.
class Onward {
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

class RayWorker : public GroundSource {
 public:
  // `own`: null for a task that holds no voxels.
  RayWorker(TaskDesk& desk, const OwnVoxels* own) : desk_(desk), own_(own) {}

  // A new epoch: everything that waits is dropped.  `finder`: this task's number among those that find intersections.
  void begin(TraceSetting setting, std::uint32_t finder);

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

  // Follows shadow rays that have come from elsewhere through this task's own voxels.
  void follow(const ShadowHead& head, std::span<const ShadowTravel> rays, const Model& model,
              const VoxelSource& voxels);

  // Is fetching the cell expected to move fewer bytes than sending on so many rays that come to it?
  bool fetchingPays(CellId missing, std::size_t rays) const;

  // Asks for a cell unless it is here or asked for already.
  void want(CellId cell);
  bool isEmpty(CellId cell) const { return at_.cellBytes[static_cast<std::size_t>(cell)] == 0; }
  bool isHere(CellId cell) const { return isEmpty(cell) || cache_.contains(cell); }
  // A cell has come; false: it was not asked for.  It stays in the cache until release(), whatever else comes in.
  bool take(CellItems&& message);
  void release(CellId cell) { cache_.unpin(cell); }

  Ground voxel(VoxelId voxel) override { return own_ == nullptr ? Ground{} : own_->own(voxel); }
  Ground cell(CellId cell) override;
  bool fetches() override { return at_.policy.shadows != ShadowPolicy::forward; }
  bool mayMeet(VoxelId voxel, const Ray& ray, double tMin, double tMax) override {
    return at_.contents.mayMeet(voxel, ray.origin, ray.direction, tMin, tMax);
  }

 private:
  struct Pending {  // a shadow ray on its way
    ShadowRay shadow;
    std::uint32_t unit = 0;
    Slot slot = 0;
  };
  struct Bundle {  // of one light and one hit
    ShadowHead head;
    std::vector<Pending> rays;
  };

  // What stopped the last shadow ray to a light point: asked first, which can't change the answer.
  struct Occluder {
    ObjectIndex object = kNone;
    std::uint32_t ground = 0;
  };

  void traceBundle(Bundle&& bundle, const LightSource& light);
  void park(Bundle&& bundle, CellId missing, const LightSource* light);
  void resume(Bundle&& bundle);
  void askMore();

  TaskDesk& desk_;
  const OwnVoxels* own_;
  TraceSetting at_;
  TraceCounts counts_;
  CacheCounts shadowCounts_;
  ObjectCache cache_;
  Model noModel_;
  Region nothing_;                             // of an empty cell
  std::vector<Occluder> occluders_;            // by light point; of rays that begin here
  std::vector<ObjectIndex> visitorOccluders_;  // the same of rays from elsewhere
  Onward onward_;
  LightAnswers settled_;

  std::uint32_t finder_ = 0;
  std::uint64_t serial_ = 0;                                       // of the next intersection found here
  std::vector<std::uint64_t> numbers_;                             // of the next record at each shade task
  std::unordered_map<std::uint32_t, std::vector<Bundle>> parked_;  // by the cell they wait for
  std::size_t parkedCount_ = 0;
  double expectedUses_ = 0;  // of a fetched cell: the less of the model the cache can hold, the fewer
  std::uint64_t combined_ = 0;
  std::unordered_set<std::uint32_t> asked_;   // cells on their way
  std::deque<CellId> toAsk_;                  // more than may be on their way
  std::unordered_set<std::uint32_t> queued_;  // in toAsk_
};

template <class Queue>
void RayWorker::shade(const Ray& ray, const ReplyTo& to, const Hit& hit, const Model& model, Queue queue) {
  const SurfacePoint at = evaluateSurface(model, hit, ray, at_.setting);
  Secondary spawned = spawnSecondary(ray, at, at_.setting);
  const std::size_t chosen = chooseShadeTask(at_.directory, serial_++);
  const TaskId shader = at_.directory.shadeTasks[chosen];
  Expect expect;
  expect.record = recordOf(finder_, numbers_[chosen]);
  expect.to = to;
  expect.gathered.light.resize(spawned.lit.size());
  const ShadowHead head{shader, expect.record, ray.moment, ray.sample, ray.key};
  onward_.begin(head);

  // Shadow rays first: those that are settled without leaving this task travel with the intersection.
  std::size_t point = 0;
  for (const LightSource& light : at_.setting.lights) {
    const std::size_t end = point + static_cast<std::size_t>(pointsOf(light));
    Bundle bundle;
    for (; point < end; ++point) {
      if (spawned.lit[point] != Lit::asked) continue;
      ++counts_.shadowRays;
      const auto slot = static_cast<Slot>(point);
      ShadowRay shadow = shadowRay(ray, at, spawned.samples[point]);
      Occluder& occluder = occluders_[point];
      shadow.occluder = occluder.object;
      shadow.occluderGround = occluder.ground;
      std::uint32_t unit = 0;
      const LocalProgress progress = followLocally(at_.tree, *this, shadow, unit, at_.setting, counts_);
      occluder = {shadow.occluder, shadow.occluderGround};
      if (progress.state != LocalProgress::State::missing) {
        expect.gathered.light[point] = progress.state == LocalProgress::State::hit ? kBlack : shadow.through;
        continue;
      }
      expect.pending.push_back(slot);
      if (at_.policy.shadows == ShadowPolicy::forward) {
        onward_.add(at_.ownerOf(progress.voxel), travelOf(shadow, slot, progress.step));
      } else {
        bundle.rays.push_back({std::move(shadow), unit, slot});
      }
    }
    if (bundle.rays.empty()) continue;
    bundle.head = head;
    traceBundle(std::move(bundle), light);
  }
  onward_.post(desk_.outbox);
  expect.hit = describe(ray, hit.t, at, spawned, at_.setting);
  const bool complete = expect.pending.empty() && !spawned.transmitted && !spawned.reflected;
  if (complete && at_.policy.shadeAtOnce) {
    ++combined_;
    answer(to, combine(expect.hit, expect.gathered, at_.setting, spawned.samples));
    return;
  }
  if (!complete) ++numbers_[chosen];
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
