// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/voxel_task.h"

#include "rayshade/scene/extract.h"
#include "rayshade/shading/evaluate.h"

namespace rayshade {

// Rays of samples that nobody needs any more may still be on their way: until the next Configure there is nothing here
// that could trace them, so no work is taken.
void VoxelTask::on(TaskId, Forget) {
  model_.emplace();
  itemsAreNew_ = true;
  desk_.epoch = Epoch{};
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
  desk_.outbox.post(from, ItemsTaken{});
}

void VoxelTask::on(TaskId from, Configure message) {
  const Directory& directory = message.directory;
  if (!isComplete(message) || message.number >= directory.voxelTasks.size()) {
    ++desk_.outbox.traffic.refused;
    return;
  }
  desk_.outbox.beginEpoch(message.epoch);
  desk_.epoch = message.epoch;
  desk_.reportLoad(from, message.loadEvery);
  dropWork();
  host_ = from;
  exhibition_ = message.exhibition;
  number_ = message.number % directory.tasksPerCluster();
  const std::uint32_t cluster = message.number / directory.tasksPerCluster();
  Contents contents(message.tree, message.cellContents);
  worker_.begin({std::move(message.setting), std::move(message.tree), std::move(message.directory), cluster,
                 message.exposure, message.policy, std::move(message.cellBytes), std::move(contents)},
                message.number);
  desk_.link.connect(worker_.at().directory.voxelTasks);
  desk_.link.connect(worker_.at().directory.shadeTasks);
  desk_.link.connect(worker_.at().directory.pyramidTasks);
  // The host never sends another tree without items, but a message may come from anybody.
  if (itemsAreNew_ || regions_.size() != voxelCount(worker_.at().tree)) buildRegions();
  itemsAreNew_ = false;
  desk_.outbox.post(from, Ready{message.epoch, arithmeticFingerprint(),
                                model_->store().objectsOf(kWorld).size(), owned_, model_->leftOut()});
}

void VoxelTask::on(TaskId, Weights message) {
  if (message.epoch == desk_.epoch) worker_.setWeights(std::move(message.shadeWeights));
}

void VoxelTask::buildRegions() {
  const TraceSetting& at = worker_.at();
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
    ++desk_.outbox.traffic.refused;
    return;
  }
  const VoxelId voxel = voxelOfCell(tree, message.cell);
  const Region* region = find(voxel);
  if (region == nullptr) {
    ++desk_.outbox.traffic.refused;
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
  desk_.outbox.post(from, CellItems{message.cell, std::move(extract.items)});
}

void VoxelTask::on(TaskId, CellItems message) {
  const CellId cell = message.cell;
  if (worker_.take(std::move(message))) {
    worker_.release(cell);
  } else {
    ++desk_.outbox.traffic.refused;
  }
}

void VoxelTask::on(TaskId from, Finish) {
  Report report = desk_.report();
  report.counts = worker_.counts();
  report.combined = worker_.combined();
  report.cache = worker_.cache().counts();
  report.shadowCache = worker_.shadowCounts();
  report.cellsServed = cellsServed_;
  report.modelBytes = model_->bytes();
  for (const auto& region : regions_)
    if (region) report.modelBytes += region->objects.capacity() * sizeof(ObjectIndex) + region->bvh.bytes();
  desk_.outbox.post(from, report);
  desk_.finished = true;
}

void VoxelTask::on(TaskId from, Ping) {
  desk_.outbox.post(from, Pong{});
  desk_.outbox.flush();
}

void VoxelTask::on(TaskId, PrimaryRays&& work) {
  if (!samplesFit(work, exhibition_.picture)) {
    ++desk_.outbox.traffic.refused;
    return;
  }
  waitingSamples_ += work.samples.size();
  primaries_.push_back({std::move(work), 0});
  desk_.notePeak(waiting());
}
void VoxelTask::on(TaskId, RayTask&& task) { queue(std::move(task)); }
void VoxelTask::on(TaskId, const ShadowTask& task) {
  shadows_.push_back({task.head, static_cast<std::uint32_t>(task.rays.size())});
  shadowRays_.insert(shadowRays_.end(), task.rays.begin(), task.rays.end());
  desk_.notePeak(waiting());
}

const Region* VoxelTask::find(VoxelId voxel) const { return regions_[static_cast<std::size_t>(voxel)].get(); }
Ground VoxelTask::own(VoxelId voxel) const { return {&*model_, find(voxel)}; }

void VoxelTask::queue(RayTask&& task) {
  constexpr int kDepths = 64;  // deeper ones share the last queue
  const auto depth = static_cast<std::size_t>(std::clamp(task.ray.depth, 0, kDepths - 1));
  if (depth >= raysByDepth_.size()) raysByDepth_.resize(depth + 1);
  raysByDepth_[depth].push_back(std::move(task));
  ++waitingRays_;
  desk_.notePeak(waiting());
}

bool VoxelTask::work(double until) {
  constexpr int kBetweenLooksAtTheClock = 16;
  for (int done = 1;; ++done) {
    if (!shadows_.empty()) {
      traceShadows();
    } else if (waitingRays_ > 0) {
      std::size_t depth = raysByDepth_.size() - 1;
      while (raysByDepth_[depth].empty()) --depth;
      RayTask task = std::move(raysByDepth_[depth].back());
      raysByDepth_[depth].pop_back();
      --waitingRays_;
      trace(task);
    } else if (!primaries_.empty()) {
      tracePrimary();
    } else {
      return false;
    }
    if (done % kBetweenLooksAtTheClock == 0 && desk_.link.now() >= until) return waiting() > 0;
  }
}

void VoxelTask::trace(RayTask& task) {
  const TraceSetting& at = worker_.at();
  const Progress progress = followRay(at.tree, *model_, *this, task.ray, task.step, worker_.counts());
  switch (progress.state) {
    case Progress::State::hit:
      worker_.shade(task.ray, task.to, progress.hit, *model_,
                    [this](RayTask&& child) { queue(std::move(child)); });
      break;
    case Progress::State::left:
      worker_.answer(task.to, missed(task.ray, at.setting));
      break;
    case Progress::State::elsewhere:
      task.step = progress.step;
      desk_.outbox.post(at.ownerOf(progress.voxel), task);
      break;
  }
}

void VoxelTask::tracePrimary() {
  Primaries& primaries = primaries_.front();
  RayTask task;
  task.ray = primaryRay(exhibition_, worker_.at().exposure, primaries.work.samples[primaries.next]);
  task.to = {host_, primaries.work.firstRecord + primaries.next, 0};
  ++worker_.counts().primaryRays;
  --waitingSamples_;
  if (++primaries.next == primaries.work.samples.size()) primaries_.pop_front();
  trace(task);
}

void VoxelTask::traceShadows() {
  const Shadows shadows = shadows_.back();
  shadows_.pop_back();
  const std::size_t first = shadowRays_.size() - shadows.rays;
  worker_.follow(shadows.head, std::span(shadowRays_).subspan(first), *model_, *this);
  shadowRays_.resize(first);
}

}  // namespace rayshade
