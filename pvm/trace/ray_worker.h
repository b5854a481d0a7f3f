// What voxel-trace and pyramid-trace tasks have in common: shading a hit, and shadow rays that are traced where they were
// spawned.
//
// Rays are traced in bundles (rayshade/trace/patchwork.h); what a bundle cannot settle goes on ray by ray.
//
// At a hit the secondary rays are spawned and a shade task is told, or the hit is shaded here (near_hits.h).  Shadow rays are followed as far as the voxels of this
// task go; what comes after is decided by the policy: `forward` sends them to the next voxel's task, `local` fetches the
// cells that are missing into the object cache and goes on when they have come (Reinhard & Jansen, section 5), `automatic`
// does what is expected to move fewer bytes.  All shadow rays from one hit to one area light are one bundle, the light
// pyramid: it waits as a whole, and the cells on its clip-list are asked for together.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <deque>
#include <map>
#include <unordered_set>

#include "pvm/messages/task_context.h"
#include "pvm/trace/local_hits.h"
#include "pvm/trace/object_cache.h"
#include "rayshade/shading/evaluate.h"
#include "rayshade/space/clip_list.h"
#include "rayshade/space/voxel_bounds.h"
#include "rayshade/trace/patchwork.h"

namespace rayshade {

// What is known of an epoch by every task that traces.
struct EpochSettings {
  SceneSettings settings;
  BinTree tree;
  Directory directory;
  std::uint32_t cluster = 0;
  Exposure exposure;
  DemandPolicy policy;
  std::vector<std::uint32_t> cellBytes;
  VoxelBounds voxelBounds;

  TaskId ownerOf(VoxelId voxel) const { return directory.ownerOf(voxel, cluster); }
};

// The voxels that a task holds itself.
class OwnVoxels {
 public:
  virtual ~OwnVoxels() = default;
  virtual RegionRef own(VoxelId voxel) const = 0;
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

// A hit of one of this task's rays.
struct FoundHit {
  const Ray* ray = nullptr;
  ReplyTo to;
  Hit hit;
  const Model* model = nullptr;
};

class RayWorker : public GroundSource, public PatchSource {
 public:
  // `own`: null for a task that holds no voxels.
  RayWorker(TaskContext& context, const OwnVoxels* own) : context_(context), own_(own) {}

  // A new epoch of this host: everything that waits is dropped.  `finder`: this task's number among those that find intersections.
  void begin(TaskId host, Configure&& message, std::uint32_t cluster, std::uint32_t finder);

  void setWeights(std::vector<std::uint32_t> weights) {
    if (weights.size() == at_.directory.shadeTasks.size()) at_.directory.shadeWeights = std::move(weights);
  }

  const EpochSettings& at() const { return at_; }
  TraceCounts& counts() { return counts_; }
  ObjectCache& cache() { return cache_; }
  const CacheCounts& shadowCounts() const { return shadowCounts_; }
  std::size_t waiting() const { return parkedCount_; }
  std::uint64_t combined() const { return combined_; }

  // What at most kBundleSize rays meet first, of what is here.
  void visit(std::span<const RayTask> rays, std::span<Patchwork::Found> found);
  // The next voxel of others, from `step` of the walk on, in which the ray could meet something before t.
  std::optional<WalkStep<VoxelId>> elsewhere(const LocalRay& ray, double t, std::uint32_t& step) const;

  // At most kBundleSize rays of this task have hit.  `queue` takes the transmitted and reflected rays.
  template <class Queue>
  void shade(std::span<const FoundHit> hits, Queue queue);

  // The colour of a ray; those of samples gather until flush().
  void answer(ReplyTo to, Color color);
  // Sends a ray of this task on to another one.
  void forward(TaskId to, RayTask& task) {
    task.to = outward(task.to);
    context_.outbox.post(to, task);
  }
  void flush() {
    sendHome();
    context_.flush();
  }

  // Shadow rays of one intersection that have come from elsewhere.
  struct Visitors {
    ShadowHead head;
    std::span<const ShadowTravel> rays;
  };
  // Follows them through this task's own voxels.
  void follow(std::span<const Visitors> visitors, const Model& model, const VoxelSource& voxels);

  // Is fetching the cell expected to move fewer bytes than sending on so many rays that come to it?
  bool fetchingPays(CellId missing, std::size_t rays) const;

  // Asks for a cell unless it is here or asked for already.
  void want(CellId cell);
  bool isEmpty(CellId cell) const { return at_.cellBytes[static_cast<std::size_t>(cell)] == 0; }
  bool isHere(CellId cell) const { return isEmpty(cell) || cache_.contains(cell); }
  // A cell has come; false: it was not asked for.  It stays in the cache until release(), whatever else comes in.
  bool take(CellItems&& message);
  void release(CellId cell) { cache_.unpin(cell); }

  RegionRef voxel(VoxelId voxel) override { return own_ == nullptr ? RegionRef{} : own_->own(voxel); }
  RegionRef cell(CellId cell) override;
  RegionRef patch(std::uint32_t number, std::size_t rays) override;
  bool fetches() override { return at_.policy.shadows != ShadowPolicy::forward; }
  bool mayMeet(VoxelId voxel, const Ray& ray, double tMin, double tMax) override {
    return at_.voxelBounds.mayMeet(voxel, ray.origin, ray.direction, tMin, tMax);
  }

 private:
  struct Pending {  // a shadow ray on its way
    ShadowRay shadow;
    std::uint32_t unit = 0;
    Slot slot = 0;
    LocalProgress missing{};  // what it misses
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

  // A hit that is being shaded.
  struct Shading {
    SurfacePoint at;
    Secondary spawned;
    Gathered gathered;             // what is known already
    std::vector<Pending> pending;  // what misses something that is not here
  };

  // A shadow ray that is not simply stopped or let through.
  struct Filtering {
    std::size_t from;  // hit
    ShadowRay shadow;
    double limit = 0;  // as far as its way is known
    enum class State : std::uint8_t { going, dark, passed, alone } state = State::going;
    LocalProgress missing{};  // where it goes on after `limit`, if anywhere
  };

  // Where others send the colour of a ray whose colour was to come here: its hit goes over to a shade task.
  ReplyTo outward(ReplyTo to);
  ReplyTo handOver(LocalHit& hit);
  // Posts expect_ but for its record to some shade task; says where the colours go.  Requires that there is one.
  ReplyTo tellShader(bool waits);

  void layPatches(std::span<const Bounds> cellBounds);
  // For a task that knows of others only where they have anything: the rays that might meet something there.
  RaySet mayLeave(std::span<Segment> segments, std::span<const double> begin) const;
  double beginOf(Vec3 origin, Vec3 direction, std::uint32_t step) const;
  // The three parts of shade().
  void lookAt(std::span<const FoundHit> hits);
  void askLight(std::span<const FoundHit> hits, std::size_t point);
  void filter();
  std::optional<ReplyTo> conclude(const FoundHit& hit, Shading& shading);
  void sendOn(const ShadowHead& head, std::span<Pending> pending);
  void sendOn(const ShadowHead& head, std::span<Pending> pending, const LightSource& light);
  void park(Bundle&& bundle, CellId missing, const LightSource* light);
  void resume(Bundle&& bundle);
  void askMore();

  static constexpr std::size_t kMostHome = 512;
  struct SampleColor {
    RecordId record;
    Color color;
  };
  void sendHome();

  TaskContext& context_;
  const OwnVoxels* own_;
  TaskId host_ = kNobody;
  std::vector<SampleColor> home_;
  EpochSettings at_;
  TraceCounts counts_;
  CacheCounts shadowCounts_;
  ObjectCache cache_;
  // One's own voxels, and the cells of all others.
  struct PatchPlace {
    VoxelId voxel{};
    CellId cell{};
    bool mine = false;
  };
  std::vector<PatchPlace> patches_;
  std::optional<Bounds> onlyVoxel_;  // one's own, if there is one only; what lies in it is all here
  bool knowsOthers_ = false;         // the cells of others are patches, too
  bool lookingForLight_ = false;     // for shadow rays, not for others
  Patchwork patchwork_;
  Patchwork others_;                           // of a task that fetches nothing: where others have anything
  std::array<Shading, kBundleSize> shadings_;  // kept: they take memory
  Model noModel_;
  Region nothing_;                   // of an empty cell
  std::vector<Occluder> occluders_;  // by light point
  Onward onward_;
  LightAnswers settled_;
  std::vector<Filtering> filtering_;
  Expect expect_;
  LocalHits near_;
  std::vector<Patchwork::Light> visitorLight_;

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
void RayWorker::shade(std::span<const FoundHit> hits, Queue queue) {
  lookAt(hits);
  const std::size_t points = lightPointCount(at_.settings);
  for (std::size_t point = 0; point < points; ++point) askLight(hits, point);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const std::optional<ReplyTo> back = conclude(hits[i], shadings_[i]);
    if (!back) continue;
    OnwardRays& onward = shadings_[i].spawned;
    if (onward.transmitted) {
      ++counts_.transmittedRays;
      queue(RayTask{std::move(*onward.transmitted), 0, {back->task, back->record, kTransmittedSlot}});
    }
    if (onward.reflected) {
      ++counts_.reflectedRays;
      queue(RayTask{std::move(*onward.reflected), 0, {back->task, back->record, kReflectedSlot}});
    }
  }
}

}  // namespace rayshade
