// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/pyramid_task.h"

#include <algorithm>

namespace rayshade {
namespace {

double distanceTo(const Bounds& box, Vec3 p) {
  Vec3 outside;
  for (int axis = 0; axis < 3; ++axis)
    outside[axis] = std::max({box.low[axis] - p[axis], p[axis] - box.high[axis], 0.0});
  return length(outside);
}

}  // namespace

void PyramidTask::on(TaskId from, Configure message) {
  if (!isComplete(message)) {
    ++context_.outbox.traffic.refused;
    return;
  }
  context_.outbox.beginEpoch(message.epoch);
  context_.epoch = message.epoch;
  context_.reportLoad(from, message.loadEvery);
  host_ = from;
  request_ = message.request;
  tiles_.clear();
  ready_.clear();
  waitingTiles_.clear();
  secondaries_.clear();
  parked_.clear();
  const std::uint32_t clusters = message.directory.clusters;
  const auto base = static_cast<std::uint32_t>(message.directory.voxelTasks.size()) + message.number;
  const std::uint32_t cluster = message.number % clusters;
  worker_.begin(from, std::move(message), cluster, base);
  context_.link.connect(worker_.at().directory.voxelTasks);
  context_.link.connect(worker_.at().directory.shadeTasks);
  context_.outbox.post(from, Ready{context_.epoch, arithmeticFingerprint(), 0, 0, 0});
  for (int i = 0; i < kAhead; ++i) context_.outbox.post(from, PyramidWanted{});
}

void PyramidTask::on(TaskId from, Finish) {
  Report report = context_.report();
  report.counts = worker_.counts();
  report.combined = worker_.combined();
  report.cache = worker_.cache().counts();
  report.shadowCache = worker_.shadowCounts();
  report.pyramids = pyramids_;
  report.pyramidRays = pyramidRays_;
  report.forwardedRays = forwarded_;
  report.modelBytes = report.cache.peakBytes;
  context_.outbox.post(from, report);
  context_.finished = true;
}

void PyramidTask::on(TaskId from, Ping) {
  context_.outbox.post(from, Pong{});
  context_.outbox.flush();
}

void PyramidTask::on(TaskId, Weights message) {
  if (message.epoch == context_.epoch) worker_.setWeights(std::move(message.shadeWeights));
}

RegionRef PyramidTask::cell(CellId cell) {
  if (worker_.isEmpty(cell)) return {&noModel_, &nothing_};
  return worker_.cache().find(cell);
}

// ---- a pyramid and its cells

std::vector<CellId> PyramidTask::cellsOf(const std::vector<Ray>& rays,
                                         const std::vector<SamplePosition>& positions) const {
  const BinTree& tree = worker_.at().tree;
  const View& view = request_.view;
  if (view.lensRight == Vec3{} && view.lensUp == Vec3{}) {
    double u0 = positions[0].u, u1 = u0, v0 = positions[0].v, v1 = v0;
    for (const SamplePosition& p : positions) {
      u0 = std::min(u0, p.u);
      u1 = std::max(u1, p.u);
      v0 = std::min(v0, p.v);
      v1 = std::max(v1, p.v);
    }
    // A little wider: a pyramid of one ray is none.
    constexpr double kMargin = 1e-3;  // pixels
    auto corner = [&](double u, double v) { return view.first + u * view.right + v * view.down; };
    return clipList(
        tree, pyramidOf(view.eye, {corner(u0 - kMargin, v0 - kMargin), corner(u1 + kMargin, v0 - kMargin),
                                   corner(u1 + kMargin, v1 + kMargin), corner(u0 - kMargin, v1 + kMargin)}));
  }
  std::map<std::uint32_t, double> nearest;  // by cell: where the first ray enters it
  for (const Ray& ray : rays) {
    CellWalk walk(tree, ray.origin, ray.direction);
    WalkStep<CellId> step;
    while (walk.next(step)) {
      const auto [at, isNew] = nearest.try_emplace(static_cast<std::uint32_t>(step.where), step.tEnter);
      if (!isNew) at->second = std::min(at->second, step.tEnter);
    }
  }
  std::vector<std::pair<double, std::uint32_t>> sorted;
  for (const auto& [cell, t] : nearest) sorted.emplace_back(t, cell);
  std::sort(sorted.begin(), sorted.end());
  std::vector<CellId> cells;
  for (const auto& [t, cell] : sorted) cells.push_back(CellId{cell});
  return cells;
}

// How many cells of a list are fetched; any number gives the same picture.
std::size_t PyramidTask::beforeHorizon(const std::vector<CellId>& cells, std::size_t rays) const {
  const EpochSettings& at = worker_.at();
  const Horizon& horizon = at.policy.horizon;
  std::size_t n = 0;
  std::uint64_t bytes = 0;
  for (; n < cells.size(); ++n) {
    const CellId cell = cells[n];
    switch (horizon.kind) {
      case Horizon::Kind::cells:
        if (static_cast<double>(n) >= horizon.value) return n;
        break;
      case Horizon::Kind::distance:
        if (distanceTo(boundsOf(at.tree, cell), request_.view.eye) > horizon.value) return n;
        break;
      case Horizon::Kind::automatic:
        // The cells of all pyramids in hand stay in the cache until they have been traced.
        bytes += at.cellBytes[static_cast<std::size_t>(cell)];
        if (bytes > at.policy.cacheBytes / kAhead) return n;
        if (!worker_.isHere(cell) && !worker_.fetchingPays(cell, rays)) return n;
        break;
    }
  }
  return n;
}

void PyramidTask::on(TaskId, PrimaryRays message) {
  const PictureSpec& picture = request_.picture;
  if (!samplesFit(message, picture)) {
    ++context_.outbox.traffic.refused;
    return;
  }
  const std::int32_t frame = worker_.at().exposure.frame;
  Tile tile;
  tile.firstRecord = message.firstRecord;
  std::vector<SamplePosition> positions;
  for (const SampleId& sample : message.samples) {
    positions.push_back(samplePosition(picture, request_.seed, static_cast<std::uint32_t>(frame), sample));
    tile.rays.push_back(primaryRay(request_.view, positions.back(), frame));
  }
  worker_.counts().primaryRays += tile.rays.size();
  std::vector<CellId> cells = cellsOf(tile.rays, positions);
  cells.resize(beforeHorizon(cells, tile.rays.size()));
  std::erase_if(cells, [this](CellId cell) { return worker_.isEmpty(cell); });
  tile.cells = std::move(cells);
  tiles_.push_back(std::move(tile));
  const auto at = std::prev(tiles_.end());
  for (CellId cell : at->cells) {
    if (worker_.cache().contains(cell)) {
      worker_.cache().pin(cell);
    } else {
      ++at->missing;
      waitingTiles_[static_cast<std::uint32_t>(cell)].push_back(at);
      worker_.want(cell);
    }
  }
  if (at->missing == 0) ready_.push_back(at);
  context_.notePeak(tiles_.size() + worker_.waiting());
}

void PyramidTask::on(TaskId, CellItems message) {
  const CellId cell = message.cell;
  const auto key = static_cast<std::uint32_t>(cell);
  if (!worker_.take(std::move(message))) {
    ++context_.outbox.traffic.refused;
    return;
  }
  if (const auto waiting = waitingTiles_.find(key); waiting != waitingTiles_.end()) {
    for (const auto tile : waiting->second) {
      worker_.cache().pin(cell);
      if (--tile->missing == 0) ready_.push_back(tile);
    }
    waitingTiles_.erase(waiting);
  }
  if (const auto waiting = parked_.find(key); waiting != parked_.end()) {
    std::vector<WaitingRay> rays = std::move(waiting->second);
    parked_.erase(waiting);
    // The cell is here now and may be gone later: each ray passes it at once.
    for (WaitingRay& ray : rays) follow(std::move(ray));
  }
  worker_.release(cell);
}

// ---- rays

bool PyramidTask::work(double until) {
  while (!secondaries_.empty() || !ready_.empty()) {
    batch_.clear();
    if (!secondaries_.empty()) {
      const std::size_t count = std::min(secondaries_.size(), kBundleSize);
      std::move(secondaries_.end() - static_cast<std::ptrdiff_t>(count), secondaries_.end(),
                std::back_inserter(batch_));
      secondaries_.resize(secondaries_.size() - count);
      trace(batch_, [this](RayTask&& task) { follow({std::move(task), 0}); });
    } else {
      Tile& tile = *ready_.front();
      while (batch_.size() < kBundleSize && tile.next < tile.rays.size()) {
        batch_.push_back({std::move(tile.rays[tile.next]), 0, {host_, tile.firstRecord + tile.next, 0}});
        ++tile.next;
      }
      trace(batch_, [this](RayTask&& task) { followToHorizon(std::move(task)); });
      if (tile.next == tile.rays.size()) {
        finish(tile);
        const auto gone = ready_.front();
        ready_.pop_front();
        tiles_.erase(gone);
      }
    }
    if (context_.link.now() >= until) break;
  }
  return !secondaries_.empty() || !ready_.empty();
}

// Rays of one pyramid, or of neighbouring hits; `alone` takes those that cannot be settled together.
template <class Alone>
void PyramidTask::trace(std::span<RayTask> tasks, Alone alone) {
  Patchwork::Found found[kBundleSize];
  worker_.visit(tasks, found);
  FoundHit hits[kBundleSize];
  std::size_t count = 0;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (!found[i].settled) {
      alone(std::move(tasks[i]));
    } else if (found[i].hit.found()) {
      hits[count++] = {&tasks[i].ray, tasks[i].to, found[i].hit, found[i].model};
    } else {
      worker_.answer(tasks[i].to, missed(tasks[i].ray, worker_.at().settings));
    }
  }
  shade(std::span(hits).first(count));
}

void PyramidTask::shade(std::span<const FoundHit> hits) {
  worker_.shade(hits, [this](RayTask&& child) { forward(std::move(child)); });
}

// A primary ray through the cells that are here; behind the horizon demand driven becomes data driven.
void PyramidTask::followToHorizon(RayTask&& task) {
  std::uint32_t unit = 0;
  const LocalProgress progress = followLocally(worker_.at().tree, *this, task.ray, unit, worker_.counts());
  if (progress.state == LocalProgress::State::missing) {
    ++forwarded_;
    task.step = progress.step;
    worker_.forward(worker_.at().ownerOf(progress.voxel), task);
  } else {
    conclude(task, progress);
  }
}

void PyramidTask::conclude(const RayTask& task, const LocalProgress& progress) {
  if (progress.state == LocalProgress::State::hit) {
    const FoundHit hit{&task.ray, task.to, progress.hit, progress.model};
    shade(std::span(&hit, 1));
  } else {
    worker_.answer(task.to, missed(task.ray, worker_.at().settings));
  }
}

void PyramidTask::finish(Tile& tile) {
  ++pyramids_;
  pyramidRays_ += tile.rays.size();
  for (CellId cell : tile.cells) worker_.cache().unpin(cell);
  context_.outbox.post(host_, PyramidWanted{});
}

// A secondary ray: to the voxel where it begins, or into the own queue.
void PyramidTask::forward(RayTask task) {
  if (!worker_.at().policy.secondariesTravel) {
    secondaries_.push_back(std::move(task));
    return;
  }
  VoxelWalk walk(worker_.at().tree, task.ray.origin, task.ray.direction);
  WalkStep<VoxelId> first;
  walk.next(first);
  worker_.forward(worker_.at().ownerOf(first.where), task);
}

// A secondary ray, which waits for every cell that it needs.
void PyramidTask::follow(WaitingRay&& waiting) {
  RayTask& task = waiting.task;
  const LocalProgress progress =
      followLocally(worker_.at().tree, *this, task.ray, waiting.unit, worker_.counts());
  if (progress.state == LocalProgress::State::missing) {
    worker_.want(progress.cell);
    parked_[static_cast<std::uint32_t>(progress.cell)].push_back(std::move(waiting));
  } else {
    conclude(task, progress);
  }
}

}  // namespace rayshade
