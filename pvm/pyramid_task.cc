// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/pyramid_task.h"

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
    ++desk_.outbox.traffic.refused;
    return;
  }
  desk_.outbox.beginEpoch(message.epoch);
  desk_.epoch = message.epoch;
  desk_.reportLoad(from, message.loadEvery);
  host_ = from;
  exhibition_ = message.exhibition;
  tiles_.clear();
  ready_.clear();
  waitingTiles_.clear();
  secondaries_.clear();
  parked_.clear();
  const std::uint32_t clusters = message.directory.clusters;
  const auto base = static_cast<std::uint32_t>(message.directory.voxelTasks.size()) + message.number;
  Contents contents(message.tree, message.cellContents);
  worker_.begin({std::move(message.setting), std::move(message.tree), std::move(message.directory),
                 message.number % clusters, message.exposure, message.policy, std::move(message.cellBytes),
                 std::move(contents)},
                base);
  desk_.link.connect(worker_.at().directory.voxelTasks);
  desk_.link.connect(worker_.at().directory.shadeTasks);
  desk_.outbox.post(from, Ready{message.epoch, arithmeticFingerprint(), 0, 0, 0});
  for (int i = 0; i < kAhead; ++i) desk_.outbox.post(from, PyramidWanted{});
}

void PyramidTask::on(TaskId from, Finish) {
  Report report = desk_.report();
  report.counts = worker_.counts();
  report.combined = worker_.combined();
  report.cache = worker_.cache().counts();
  report.shadowCache = worker_.shadowCounts();
  report.pyramids = pyramids_;
  report.pyramidRays = pyramidRays_;
  report.forwardedRays = forwarded_;
  report.modelBytes = report.cache.peakBytes;
  desk_.outbox.post(from, report);
  desk_.finished = true;
}

void PyramidTask::on(TaskId from, Ping) {
  desk_.outbox.post(from, Pong{});
  desk_.outbox.flush();
}

void PyramidTask::on(TaskId, Weights message) {
  if (message.epoch == desk_.epoch) worker_.setWeights(std::move(message.shadeWeights));
}

Ground PyramidTask::cell(CellId cell) {
  if (worker_.isEmpty(cell)) return {&noModel_, &nothing_};
  return worker_.cache().find(cell);
}

// ---- a pyramid and its cells

std::vector<CellId> PyramidTask::cellsOf(const std::vector<Ray>& rays,
                                         const std::vector<SamplePosition>& positions) const {
  const BinTree& tree = worker_.at().tree;
  const View& view = exhibition_.view;
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
  const TraceSetting& at = worker_.at();
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
        if (distanceTo(boundsOf(at.tree, cell), exhibition_.view.eye) > horizon.value) return n;
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
  const PictureSpec& picture = exhibition_.picture;
  if (!samplesFit(message, picture)) {
    ++desk_.outbox.traffic.refused;
    return;
  }
  const std::int32_t frame = worker_.at().exposure.frame;
  Tile tile;
  tile.firstRecord = message.firstRecord;
  std::vector<SamplePosition> positions;
  for (const SampleId& sample : message.samples) {
    positions.push_back(samplePosition(picture, exhibition_.seed, static_cast<std::uint32_t>(frame), sample));
    tile.rays.push_back(primaryRay(exhibition_.view, positions.back(), frame));
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
  desk_.notePeak(tiles_.size() + worker_.waiting());
}

void PyramidTask::on(TaskId, CellItems message) {
  const CellId cell = message.cell;
  const auto key = static_cast<std::uint32_t>(cell);
  if (!worker_.take(std::move(message))) {
    ++desk_.outbox.traffic.refused;
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
    for (WaitingRay& ray : rays) trace(std::move(ray));
  }
  worker_.release(cell);
}

// ---- rays

bool PyramidTask::work(double until) {
  for (int done = 1; !secondaries_.empty() || !ready_.empty(); ++done) {
    if (!secondaries_.empty()) {
      WaitingRay ray = std::move(secondaries_.back());
      secondaries_.pop_back();
      trace(std::move(ray));
    } else {
      Tile& tile = *ready_.front();
      trace(tile);
      if (tile.next == tile.rays.size()) {
        finish(tile);
        const auto gone = ready_.front();
        ready_.pop_front();
        tiles_.erase(gone);
      }
    }
    if (done % 16 == 0 && desk_.link.now() >= until) break;
  }
  return !secondaries_.empty() || !ready_.empty();
}

// The next ray of a tile.
void PyramidTask::trace(Tile& tile) {
  Ray& ray = tile.rays[tile.next];
  const ReplyTo to{host_, tile.firstRecord + tile.next, 0};
  ++tile.next;
  std::uint32_t unit = 0;
  const LocalProgress progress = followLocally(worker_.at().tree, *this, ray, unit, worker_.counts());
  switch (progress.state) {
    case LocalProgress::State::hit:
      worker_.shade(ray, to, progress.hit, *progress.model,
                    [this](RayTask&& child) { forward(std::move(child)); });
      break;
    case LocalProgress::State::left:
      worker_.answer(to, missed(ray, worker_.at().setting));
      break;
    case LocalProgress::State::missing:  // behind the horizon: demand driven becomes data driven
      ++forwarded_;
      desk_.outbox.post(worker_.at().ownerOf(progress.voxel), RayTask{std::move(ray), progress.step, to});
      break;
  }
}

void PyramidTask::finish(Tile& tile) {
  ++pyramids_;
  pyramidRays_ += tile.rays.size();
  for (CellId cell : tile.cells) worker_.cache().unpin(cell);
  desk_.outbox.post(host_, PyramidWanted{});
}

// A secondary ray: to the voxel where it begins, or into the own queue.
void PyramidTask::forward(RayTask task) {
  if (!worker_.at().policy.secondariesTravel) {
    secondaries_.push_back({std::move(task), 0});
    return;
  }
  VoxelWalk walk(worker_.at().tree, task.ray.origin, task.ray.direction);
  WalkStep<VoxelId> first;
  walk.next(first);
  desk_.outbox.post(worker_.at().ownerOf(first.where), task);
}

void PyramidTask::trace(WaitingRay&& waiting) {
  RayTask& task = waiting.task;
  const LocalProgress progress =
      followLocally(worker_.at().tree, *this, task.ray, waiting.unit, worker_.counts());
  switch (progress.state) {
    case LocalProgress::State::hit:
      worker_.shade(task.ray, task.to, progress.hit, *progress.model,
                    [this](RayTask&& child) { forward(std::move(child)); });
      break;
    case LocalProgress::State::left:
      worker_.answer(task.to, missed(task.ray, worker_.at().setting));
      break;
    case LocalProgress::State::missing:
      worker_.want(progress.cell);
      parked_[static_cast<std::uint32_t>(progress.cell)].push_back(std::move(waiting));
      break;
  }
}

}  // namespace rayshade
