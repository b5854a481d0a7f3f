// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/voxel_task.h"

#include "rayshade/scene/extract.h"
#include "rayshade/shading/evaluate.h"

namespace rayshade {

// Rays of samples that nobody needs any more may still be on their way: until the next Configure there is nothing here
// that could trace them, so no work is taken.
void VoxelTask::on(TaskId, Forget) {
  model_.emplace();
  itemsAreNew_ = true;
  context_.epoch = Epoch{};
  dropWork();
  regions_.clear();
}

void VoxelTask::dropWork() {
  primaries_.clear();
  waitingSamples_ = 0;
  raysByDepth_.clear();
  waitingRays_ = 0;
  shadows_.clear();
  shadowRays_.clear();
}

void VoxelTask::on(TaskId from, Items message) {
  model_->take(std::move(message.items));
  itemsAreNew_ = true;
  context_.outbox.post(from, ItemsTaken{});
}

void VoxelTask::on(TaskId from, Configure message) {
  const Directory& directory = message.directory;
  if (!isComplete(message) || message.number >= directory.voxelTasks.size()) {
    ++context_.outbox.traffic.refused;
    return;
  }
  context_.outbox.beginEpoch(message.epoch);
  context_.epoch = message.epoch;
  context_.reportLoad(from, message.loadEvery);
  dropWork();
  host_ = from;
  request_ = message.request;
  number_ = message.number % directory.tasksPerCluster();
  const std::uint32_t number = message.number, cluster = number / directory.tasksPerCluster();
  worker_.begin(from, std::move(message), cluster, number);
  context_.link.connect(worker_.at().directory.voxelTasks);
  context_.link.connect(worker_.at().directory.shadeTasks);
  context_.link.connect(worker_.at().directory.pyramidTasks);
  // The host never sends another tree without items, but a message may come from anybody.
  if (itemsAreNew_ || regions_.size() != voxelCount(worker_.at().tree)) buildRegions();
  itemsAreNew_ = false;
  context_.outbox.post(from, Ready{context_.epoch, arithmeticFingerprint(),
                                   model_->store().objectsOf(kWorld).size(), owned_, model_->leftOut()});
}

void VoxelTask::on(TaskId, Weights message) {
  if (message.epoch == context_.epoch) worker_.setWeights(std::move(message.shadeWeights));
}

void VoxelTask::buildRegions() {
  const EpochSettings& at = worker_.at();
  model_->prepare(at.exposure);
  cellObjects_.clear();
  std::vector<std::vector<ObjectIndex>> members(voxelCount(at.tree));
  std::vector<VoxelId> touched;
  owned_ = 0;
  for (ObjectIndex object : model_->store().objectsOf(kWorld)) {
    touched.clear();
    voxelsTouching(at.tree, model_->boundsOf(object), touched);
    // Every object belongs to the first voxel that it touches; there it counts.
    if (!touched.empty() && at.directory.voxels[static_cast<std::size_t>(touched.front())] == number_)
      ++owned_;
    for (VoxelId voxel : touched) members[static_cast<std::size_t>(voxel)].push_back(object);
  }
  regions_.clear();
  for (std::size_t voxel = 0; voxel < members.size(); ++voxel) {
    const bool mine = at.directory.voxels[voxel] == number_;
    regions_.push_back(mine ? std::make_unique<Region>(model_->regionOf(std::move(members[voxel])))
                            : nullptr);
  }
}

// A cell for somebody else's cache.  Which objects lie in which cell of a voxel is found out when the first one is asked for.
void VoxelTask::on(TaskId from, CellWanted message) {
  const BinTree& tree = worker_.at().tree;
  if (static_cast<std::size_t>(message.cell) >= cellCount(tree)) {
    ++context_.outbox.traffic.refused;
    return;
  }
  const VoxelId voxel = voxelOfCell(tree, message.cell);
  const Region* region = find(voxel);
  if (region == nullptr) {
    ++context_.outbox.traffic.refused;
    return;
  }
  const auto key = static_cast<std::uint32_t>(message.cell);
  if (!cellObjects_.contains(key)) {
    std::vector<CellId> cells;
    for (const Target& target : region->objects) {
      const ObjectIndex object = target.object;
      cells.clear();
      cellsTouching(tree, model_->boundsOf(object), cells);
      for (CellId cell : cells)
        if (voxelOfCell(tree, cell) == voxel)
          cellObjects_[static_cast<std::uint32_t>(cell)].push_back(object);
    }
    cellObjects_[key];
  }
  Extract extract(model_->store());
  for (ObjectIndex object : cellObjects_[key]) extract.add(object);
  ++cellsServed_;
  context_.outbox.post(from, CellItems{message.cell, std::move(extract.items)});
}

void VoxelTask::on(TaskId, CellItems message) {
  const CellId cell = message.cell;
  if (worker_.take(std::move(message))) {
    worker_.release(cell);
  } else {
    ++context_.outbox.traffic.refused;
  }
}

void VoxelTask::on(TaskId from, Finish) {
  Report report = context_.report();
  report.counts = worker_.counts();
  report.combined = worker_.combined();
  report.cache = worker_.cache().counts();
  report.shadowCache = worker_.shadowCounts();
  report.cellsServed = cellsServed_;
  report.modelBytes = model_->bytes();
  for (const auto& region : regions_)
    if (region) report.modelBytes += region->objects.capacity() * sizeof(ObjectIndex) + region->bvh.bytes();
  context_.outbox.post(from, report);
  context_.finished = true;
}

void VoxelTask::on(TaskId from, Ping) {
  context_.outbox.post(from, Pong{});
  context_.outbox.flush();
}

void VoxelTask::on(TaskId, PrimaryRays&& work) {
  if (!samplesFit(work, request_.picture)) {
    ++context_.outbox.traffic.refused;
    return;
  }
  waitingSamples_ += work.samples.size();
  primaries_.push_back({std::move(work), 0});
  context_.notePeak(waiting());
}
void VoxelTask::on(TaskId, RayTask&& task) {
  if (task.to.task == context_.link.self()) {  // colours of rays that have left are sent elsewhere
    ++context_.outbox.traffic.refused;
    return;
  }
  queue(std::move(task));
}
void VoxelTask::on(TaskId, const ShadowTask& task) {
  shadows_.push_back({task.head, static_cast<std::uint32_t>(task.rays.size())});
  shadowRays_.insert(shadowRays_.end(), task.rays.begin(), task.rays.end());
  context_.notePeak(waiting());
}

const Region* VoxelTask::find(VoxelId voxel) const { return regions_[static_cast<std::size_t>(voxel)].get(); }
RegionRef VoxelTask::own(VoxelId voxel) const { return {&*model_, find(voxel)}; }

void VoxelTask::queue(RayTask&& task) {
  constexpr int kDepths = 64;  // deeper ones share the last queue
  const auto depth = static_cast<std::size_t>(std::clamp(task.ray.depth, 0, kDepths - 1));
  if (depth >= raysByDepth_.size()) raysByDepth_.resize(depth + 1);
  raysByDepth_[depth].push_back(std::move(task));
  ++waitingRays_;
  context_.notePeak(waiting());
}

bool VoxelTask::work(double until) {
  while (waiting() > 0) {
    if (!shadows_.empty()) {
      traceShadows();
    } else {
      batch_.clear();
      if (waitingRays_ > 0) {
        takeDeepest();
      } else {
        takePrimaries();
      }
      trace(batch_);
    }
    if (context_.link.now() >= until) break;
  }
  return waiting() > 0;
}

// Rays of one depth, so that neighbours stay together.
void VoxelTask::takeDeepest() {
  std::size_t depth = raysByDepth_.size() - 1;
  while (raysByDepth_[depth].empty()) --depth;
  std::vector<RayTask>& rays = raysByDepth_[depth];
  const std::size_t count = std::min(rays.size(), kBundleSize);
  std::move(rays.end() - static_cast<std::ptrdiff_t>(count), rays.end(), std::back_inserter(batch_));
  rays.resize(rays.size() - count);
  waitingRays_ -= count;
}

void VoxelTask::takePrimaries() {
  while (!primaries_.empty() && batch_.size() < kBundleSize) {
    Primaries& primaries = primaries_.front();
    batch_.push_back({primaryRay(request_, worker_.at().exposure, primaries.work.samples[primaries.next]),
                      0,
                      {host_, primaries.work.firstRecord + primaries.next, 0}});
    if (++primaries.next == primaries.work.samples.size()) primaries_.pop_front();
  }
  waitingSamples_ -= batch_.size();
  worker_.counts().primaryRays += batch_.size();
}

void VoxelTask::trace(std::span<RayTask> tasks) {
  const EpochSettings& at = worker_.at();
  Patchwork::Found found[kBundleSize];
  worker_.visit(tasks, found);
  FoundHit hits[kBundleSize];
  std::size_t count = 0;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    RayTask& task = tasks[i];
    if (!found[i].settled) {
      const LocalRay ray{task.ray.origin, task.ray.direction, 1};
      if (const auto next = worker_.elsewhere(ray, found[i].hit.t, task.step)) {
        worker_.forward(at.ownerOf(next->where), task);
        continue;
      }
      worker_.counts().hits += found[i].hit.found();
    }
    if (found[i].hit.found()) {
      hits[count++] = {&task.ray, task.to, found[i].hit, found[i].model};
    } else {
      worker_.answer(task.to, missed(task.ray, at.settings));
    }
  }
  worker_.shade(std::span(hits).first(count), [this](RayTask&& child) { queue(std::move(child)); });
}

// Some of the shadow rays that came last.
void VoxelTask::traceShadows() {
  std::size_t first = shadows_.size(), rays = 0;
  while (first > 0 && rays < kBundleSize) rays += shadows_[--first].rays;
  visitors_.clear();
  std::size_t next = shadowRays_.size() - rays;
  for (std::size_t i = first; i < shadows_.size(); ++i) {
    visitors_.push_back({shadows_[i].head, std::span(shadowRays_).subspan(next, shadows_[i].rays)});
    next += shadows_[i].rays;
  }
  worker_.follow(visitors_, *model_, *this);
  shadows_.resize(first);
  shadowRays_.resize(shadowRays_.size() - rays);
}

}  // namespace rayshade
