// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/voxel_task.h"

#include "rayshade/shading/evaluate.h"

namespace rayshade {

void VoxelTask::on(TaskId, Forget) {
  model_.emplace();
  itemsAreNew_ = true;
}

void VoxelTask::on(TaskId from, Items message) {
  model_->take(std::move(message.items));
  itemsAreNew_ = true;
  desk_.outbox.post(from, ItemsTaken{});
}

void VoxelTask::on(TaskId from, Configure message) {
  if (!isComplete(message.directory, message.tree) || message.number >= message.directory.voxelTasks.size()) {
    ++desk_.outbox.traffic.refused;
    return;
  }
  desk_.outbox.beginEpoch(message.epoch);
  desk_.epoch = message.epoch;
  raysByDepth_.clear();
  waitingRays_ = 0;
  shadows_.clear();
  setting_ = std::move(message.setting);
  lightPoints_ = lightPointCount(setting_);
  tree_ = std::move(message.tree);
  directory_ = std::move(message.directory);
  number_ = message.number;
  exposure_ = message.exposure;
  desk_.link.connect(directory_.voxelTasks);
  desk_.link.connect(directory_.shadeTasks);
  if (itemsAreNew_) buildRegions();
  itemsAreNew_ = false;
  desk_.outbox.post(from, Ready{message.epoch, arithmeticFingerprint(), model_->store().objectsOf(kWorld).size(),
                                owned_, model_->leftOut()});
}

void VoxelTask::buildRegions() {
  model_->prepare(exposure_);
  std::vector<std::vector<ObjectIndex>> members(voxelCount(tree_));
  std::vector<VoxelId> touched;
  owned_ = 0;
  for (ObjectIndex object : model_->store().objectsOf(kWorld)) {
    touched.clear();
    voxelsTouching(tree_, model_->boundsOf(object), touched);
    // Every object belongs to the first voxel that it touches; there it counts.
    if (!touched.empty() && directory_.voxels[static_cast<std::size_t>(touched.front())] == number_) ++owned_;
    for (VoxelId voxel : touched) members[static_cast<std::size_t>(voxel)].push_back(object);
  }
  regions_.clear();
  for (std::size_t voxel = 0; voxel < members.size(); ++voxel) {
    const bool mine = directory_.voxels[voxel] == number_;
    regions_.push_back(mine ? std::make_unique<Region>(model_->regionOf(std::move(members[voxel]))) : nullptr);
  }
}

void VoxelTask::on(TaskId from, Finish) {
  Report report = desk_.report();
  report.counts = counts_;
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

void VoxelTask::on(TaskId, RayTask task) { queue(std::move(task)); }
void VoxelTask::on(TaskId, ShadowTask task) {
  shadows_.push_back(std::move(task));
  desk_.notePeak(waiting());
}

const Region* VoxelTask::find(VoxelId voxel) const { return regions_[static_cast<std::size_t>(voxel)].get(); }

void VoxelTask::queue(RayTask task) {
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
      ShadowTask task = std::move(shadows_.back());
      shadows_.pop_back();
      trace(task);
    } else if (waitingRays_ > 0) {
      std::size_t depth = raysByDepth_.size() - 1;
      while (raysByDepth_[depth].empty()) --depth;
      RayTask task = std::move(raysByDepth_[depth].back());
      raysByDepth_[depth].pop_back();
      --waitingRays_;
      trace(task);
    } else {
      return false;
    }
    if (done % kBetweenLooksAtTheClock == 0 && desk_.link.now() >= until) return waiting() > 0;
  }
}

void VoxelTask::answer(const ReplyTo& to, Color color) {
  desk_.outbox.post(to.task, Answer{to.record, to.slot, color});
}

void VoxelTask::trace(RayTask& task) {
  const Progress progress = followRay(tree_, *model_, *this, task.ray, task.step, counts_);
  switch (progress.state) {
    case Progress::State::hit: shade(task, progress.hit); break;
    case Progress::State::left: answer(task.to, missed(task.ray, setting_)); break;
    case Progress::State::elsewhere:
      task.step = progress.step;
      desk_.outbox.post(directory_.ownerOf(progress.voxel), task);
      break;
  }
}

void VoxelTask::trace(ShadowTask& task) {
  const Progress progress = followShadow(tree_, *model_, *this, task.shadow, task.step, setting_, counts_);
  switch (progress.state) {
    case Progress::State::hit: answer(task.to, kBlack); break;
    case Progress::State::left: answer(task.to, task.shadow.through); break;
    case Progress::State::elsewhere:
      task.step = progress.step;
      desk_.outbox.post(directory_.ownerOf(progress.voxel), task);
      break;
  }
}

// Spawns the secondary rays and informs a shade task.  Shadow rays that find their light without leaving this task
// are settled at once, and their colours travel with the intersection.
void VoxelTask::shade(RayTask& task, const Hit& hit) {
  const SurfacePoint at = evaluateSurface(*model_, hit, task.ray, setting_);
  Secondary spawned = spawnSecondary(task.ray, at, setting_);
  Expect expect;
  expect.record = static_cast<RecordId>(number_) << 48 | (serial_++ & 0xffffffffffffu);
  expect.to = task.to;
  const TaskId shader = directory_.shadeTasks[serial_ % directory_.shadeTasks.size()];
  for (std::size_t point = 0; point < spawned.lit.size(); ++point) {
    if (spawned.lit[point] != Lit::asked) continue;
    ++counts_.shadowRays;
    ShadowTask shadow{shadowRay(task.ray, at, setting_, point), 0, {shader, expect.record, static_cast<Slot>(point)}};
    const Progress progress = followShadow(tree_, *model_, *this, shadow.shadow, 0, setting_, counts_);
    if (progress.state == Progress::State::elsewhere) {
      shadow.step = progress.step;
      expect.pending.push_back(static_cast<Slot>(point));
      desk_.outbox.post(directory_.ownerOf(progress.voxel), shadow);
    } else {
      expect.known.push_back(progress.state == Progress::State::hit ? kBlack : shadow.shadow.through);
    }
  }
  expect.hit = describe(task.ray, hit.t, at, spawned, setting_);
  desk_.outbox.post(shader, expect);
  if (spawned.transmitted) {
    ++counts_.transmittedRays;
    queue({std::move(*spawned.transmitted), 0, {shader, expect.record, kTransmittedSlot}});
  }
  if (spawned.reflected) {
    ++counts_.reflectedRays;
    queue({std::move(*spawned.reflected), 0, {shader, expect.record, kReflectedSlot}});
  }
}

}  // namespace rayshade
