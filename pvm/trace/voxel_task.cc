// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/voxel_task.h"

#include "rayshade/base/arithmetic.h"

namespace rayshade {

// Rays of samples that nobody needs any more may still be on their way: until the next Configure there is nothing here
// that could trace them, so no work is taken.
void VoxelTask::on(TaskId, Forget) {
  share_.forget();
  context_.epoch = Epoch{};
  dropWork();
}

void VoxelTask::dropWork() {
  samples_.clear();
  rays_.clear();
  shadows_.clear();
}

void VoxelTask::on(TaskId from, Items message) {
  context_.outbox.post(from, ItemsTaken{});
  if (!unit_.images.fill(message.items)) {
    ++context_.outbox.traffic.refused;
    return;
  }
  share_.take(std::move(message.items));
}

void VoxelTask::on(TaskId from, Configure message) {
  const Directory& directory = message.directory;
  const std::optional<std::uint32_t> place = placeAmong(directory.voxelTasks, context_.link.self());
  if (!isComplete(message) || !place) {
    ++context_.outbox.traffic.refused;
    return;
  }
  jobs_.stop();
  context_.beginEpoch(from, message);
  dropWork();
  host_ = from;
  const std::uint32_t number = *place, perCluster = directory.tasksPerCluster();
  onlyTracer_ = directory.pyramidTasks.empty();
  takesTiles_ = inTiles(message) && (onlyTracer_ || message.policy.secondariesTravel);
  // Together the tasks of a machine have no more threads than it has cores, but each has one.
  const unsigned share = std::max(1u, context_.link.cores() / tracersBeside(directory, number));
  const unsigned threads = message.threads > 0 ? std::min(message.threads, share) : share;
  unit_.begin(from, std::move(message), number / perCluster, number);
  unit_.fetchesForRays = takesTiles_ && unit_.space.blocks().fetches();
  holders_.begin(unit_.at.directory, context_.link.self());
  share_.prepare(unit_.at.exposure, unit_.at.tree, unit_.at.directory.voxels, number % perCluster);
  context_.outbox.post(from, Ready{context_.epoch, arithmeticFingerprint(), share_.objects(), share_.owned(),
                                   share_.leftOut()});
  if (takesTiles_ && threads > 1 && unit_.space.blocks().allHeld()) jobs_.begin(from, *unit_.rules, threads);
}

void VoxelTask::on(TaskId, Weights message) { unit_.setWeights(message); }

// A cell for somebody else's cache: from here, or from somebody who got it before.
void VoxelTask::on(TaskId from, CellWanted message) {
  const bool known = static_cast<std::size_t>(message.cell) < cellCount(unit_.at.tree);
  if (known && !share_.holds(message.cell, unit_.at.tree)) return unit_.giveOn(message);
  const bool cameBack = message.asker != kNobody;
  if (cameBack) {
    holders_.forget(message.cell, from);
  } else {
    message.asker = from;
  }
  const TaskId giver = known ? holders_.choose(message.cell, message.asker) : kNobody;
  if (giver == kNobody) {
    ++context_.outbox.traffic.refused;
  } else if (giver != context_.link.self() && !cameBack) {
    context_.outbox.post(giver, message);
  } else {
    ++unit_.cellsServed;
    context_.outbox.post(message.asker, CellItems{message.cell, share_.itemsOf(message.cell, unit_.at.tree)});
  }
}

void VoxelTask::on(TaskId, CellItems message) {
  const CellId cell = message.cell;
  if (!unit_.images.fill(message.items) || !unit_.cells.arrive(std::move(message))) {
    ++context_.outbox.traffic.refused;
    return;
  }
  for (RayBundle rays = unit_.arrive(cell); !rays.empty();) {
    bundle_.clear();
    rays.moveLast(std::min(rays.size(), kBundleSize), bundle_);
    traceBundle();
  }
}

Report VoxelTask::counted() const {
  Report report = context_.counted();
  unit_.addTo(report);
  report.counts = report.counts + jobs_.counts();
  report.combined += jobs_.counts().hits;
  report.pyramids += jobs_.pyramids();
  report.pyramidRays += jobs_.pyramidRays();
  return report;
}

void VoxelTask::on(TaskId from, Finish) {
  jobs_.stop();
  context_.close();
  Report report = context_.closed(counted());
  report.modelBytes = share_.bytes();
  context_.outbox.post(from, report);
  context_.finished = true;
}

void VoxelTask::on(TaskId from, Ping) {
  context_.outbox.post(from, Pong{});
  context_.outbox.flush();
}

void VoxelTask::on(TaskId, PrimaryRays&& work) {
  if (!samplesFit(work, unit_.at.request.picture)) {
    ++context_.outbox.traffic.refused;
    return;
  }
  if (jobs_.active()) {
    jobs_.add(std::move(work));
    return;
  }
  samples_.add(std::move(work));
  unit_.noteWork();
  context_.notePeak(waiting());
}

void VoxelTask::on(TaskId, TileWork message) {
  if (!fits(message.tile, *unit_.rules) || unit_.tiles.has(message.number)) {
    ++context_.outbox.traffic.refused;
    return;
  }
  if (jobs_.active()) {
    jobs_.add(message);
    return;
  }
  unit_.tiles.add(message.number, TileSampler(*unit_.rules, message.tile));
  unit_.noteWork();
  context_.notePeak(waiting());
}

void VoxelTask::on(TaskId, const Answer& message) {
  unit_.replies.answer({context_.link.self(), message.record, message.slot}, message.color);
}

void VoxelTask::on(TaskId, RayTask&& task) {
  const double begin = walkedTo(unit_.at.tree, task.ray.origin, task.ray.direction, task.step);
  rays_.add(std::move(task.ray), begin, task.to);
  context_.notePeak(waiting());
}

void VoxelTask::on(TaskId, const ShadowTask& task) {
  shadows_.add(task);
  context_.notePeak(waiting());
}

bool VoxelTask::work(double until) {
  const TaskContext::Doing doing(context_, EventKind::trace);
  while (traceSome())
    if (context_.link.now() >= until) return true;
  return false;
}

// False: there is nothing that could be done now.
bool VoxelTask::traceSome() {
  jobs_.send(host_);
  unit_.space.settle();
  bool any = true;
  if (shadows_.bundles() > 0) {
    traceShadows();
  } else if (rays_.size() > 0 || samples_.waiting() > 0) {
    bundle_.clear();
    if (rays_.size() > 0) {
      rays_.takeDeepest(kBundleSize, bundle_);
    } else {
      takePrimaries();
    }
    traceBundle();
  } else {
    any = unit_.traceTile([this](Ray&& ray, const ReplyTo& to) { queue(std::move(ray), to); });
  }
  unit_.sendTiles(host_);
  // Where there are pyramid tasks, who is busy with rays leaves tiles to those who are idle.
  if (takesTiles_ && !jobs_.active() && (onlyTracer_ || !any)) unit_.wantTiles(host_);
  return any;
}

void VoxelTask::flush() {
  unit_.replies.flush();
  context_.flush();
}

void VoxelTask::takePrimaries() {
  samples_.take(kBundleSize, [&](const SampleId& sample, RecordId record) {
    bundle_.add(primaryRay(unit_.at.request, unit_.at.exposure, sample), 0, {host_, record, 0});
  });
  unit_.counts.primaryRays += bundle_.size();
}

void VoxelTask::traceBundle() {
  unit_.trace(bundle_.rays, bundle_.begin, bundle_.to,
              [this](Ray&& ray, const ReplyTo& to) { queue(std::move(ray), to); });
}

void VoxelTask::queue(Ray&& ray, const ReplyTo& to) {
  rays_.add(std::move(ray), 0, to);
  context_.notePeak(waiting());
}

void VoxelTask::traceShadows() {
  unit_.shadows.follow(shadows_.last(kBundleSize));
  shadows_.pop();
}

}  // namespace rayshade
