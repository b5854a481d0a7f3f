// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/pyramid_task.h"

#include <algorithm>

#include "rayshade/space/walk.h"

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
  const std::optional<std::uint32_t> place = placeAmong(message.directory.pyramidTasks, context_.link.self());
  if (!isComplete(message) || !place) {
    ++context_.outbox.traffic.refused;
    return;
  }
  context_.beginEpoch(from, message);
  host_ = from;
  tiles_.clear();
  secondaries_.clear();
  waitingForCell_.clear();
  const std::uint32_t cluster = *place % message.directory.clusters;
  const auto finder = static_cast<std::uint32_t>(message.directory.voxelTasks.size()) + *place;
  unit_.begin(from, std::move(message), cluster, finder);
  context_.outbox.post(from, Ready{context_.epoch, arithmeticFingerprint(), 0, 0, 0});
  for (int i = 0; i < kAhead; ++i) context_.outbox.post(from, PyramidWanted{});
}

void PyramidTask::on(TaskId from, Finish) {
  Report report = context_.report();
  unit_.addTo(report);
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

void PyramidTask::on(TaskId, Weights message) { unit_.setWeights(message); }

void PyramidTask::flush() {
  unit_.replies.flush();
  context_.flush();
}

// ---- a pyramid and its cells

// How many cells of a list are fetched; any number gives the same picture.
std::size_t PyramidTask::beforeHorizon(const std::vector<CellId>& cells, std::size_t rays) const {
  const EpochSettings& at = unit_.at;
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
        if (distanceTo(boundsOf(at.tree, cell), at.request.view.eye) > horizon.value) return n;
        break;
      case Horizon::Kind::automatic:
        // The cells of all pyramids in hand stay in the cache until they have been traced.
        bytes += at.cellBytes[static_cast<std::size_t>(cell)];
        if (bytes > at.policy.cacheBytes / kAhead) return n;
        if (!unit_.cells.isHere(cell) && !unit_.cells.fetchingPays(cell, rays)) return n;
        break;
    }
  }
  return n;
}

void PyramidTask::on(TaskId, PrimaryRays message) {
  const FrameRequest& request = unit_.at.request;
  if (!samplesFit(message, request.picture)) {
    ++context_.outbox.traffic.refused;
    return;
  }
  const std::int32_t frame = unit_.at.exposure.frame;
  Tile tile;
  tile.firstRecord = message.firstRecord;
  std::vector<SamplePosition> positions;
  for (const SampleId& sample : message.samples) {
    positions.push_back(
        samplePosition(request.picture, request.seed, static_cast<std::uint32_t>(frame), sample));
    tile.rays.push_back(primaryRay(request.view, positions.back(), frame));
  }
  unit_.counts.primaryRays += tile.rays.size();
  tile.cells = cellsOf(unit_.at.tree, request.view, tile.rays, positions);
  tile.cells.resize(beforeHorizon(tile.cells, tile.rays.size()));
  std::erase_if(tile.cells, [this](CellId cell) { return unit_.at.isEmpty(cell); });
  tiles_.add(
      std::move(tile),
      [this](CellId cell) {
        const bool here = unit_.cache.contains(cell);
        if (here) unit_.cache.pin(cell);
        return here;
      },
      [this](CellId cell) { unit_.cells.want(cell); });
  context_.notePeak(tiles_.size() + unit_.shadows.waiting());
}

void PyramidTask::on(TaskId, CellItems message) {
  const CellId cell = message.cell;
  if (!unit_.cells.arrive(std::move(message))) {
    ++context_.outbox.traffic.refused;
    return;
  }
  unit_.shadows.resume(cell);
  tiles_.arrive(cell, [&] { unit_.cache.pin(cell); });
  if (const auto waiting = waitingForCell_.find(static_cast<std::uint32_t>(cell));
      waiting != waitingForCell_.end()) {
    RayBundle rays = std::move(waiting->second);
    waitingForCell_.erase(waiting);
    // The cell is here now and may be gone later: each ray passes it at once.
    while (!rays.empty()) traceSecondaries(rays);
  }
  unit_.cells.release(cell);
}

// ---- rays

bool PyramidTask::work(double until) {
  while (!secondaries_.empty() || tiles_.anyReady()) {
    if (!secondaries_.empty()) {
      traceSecondaries(secondaries_);
    } else {
      tracePyramid();
    }
    if (context_.link.now() >= until) break;
  }
  return !secondaries_.empty() || tiles_.anyReady();
}

// The next bundle of a pyramid, with the cells that are here; behind the horizon demand driven becomes data driven.
void PyramidTask::tracePyramid() {
  Tile& tile = tiles_.front();
  const std::size_t count = std::min(kBundleSize, tile.rays.size() - tile.next);
  const std::span<Ray> rays = std::span(tile.rays).subspan(tile.next, count);
  ReplyTo to[kBundleSize];
  for (std::size_t i = 0; i < count; ++i) to[i] = {host_, tile.firstRecord + tile.next + i, 0};
  unit_.trace(
      rays, {}, to, [this](Ray&& ray, const ReplyTo& reply) { goOn(std::move(ray), reply); },
      [&](std::size_t i, const NextBlock& next) {
        ++forwarded_;
        unit_.replies.forward(unit_.at.ownerOf(next.voxel), std::move(rays[i]), next.step, to[i]);
      });
  tile.next += count;
  if (tile.next < tile.rays.size()) return;
  finish(tile);
  tiles_.popFront();
}

void PyramidTask::finish(Tile& tile) {
  ++pyramids_;
  pyramidRays_ += tile.rays.size();
  for (CellId cell : tile.cells) unit_.cache.unpin(cell);
  context_.outbox.post(host_, PyramidWanted{});
}

// A ray that goes on from a hit: to the voxel where it begins, or into the own queue.
void PyramidTask::goOn(Ray&& ray, const ReplyTo& to) {
  if (!unit_.at.policy.secondariesTravel) {
    secondaries_.add(std::move(ray), 0, to);
    return;
  }
  VoxelWalk walk(unit_.at.tree, ray.origin, ray.direction);
  WalkStep<VoxelId> first;
  walk.next(first);
  unit_.replies.forward(unit_.at.ownerOf(first.where), std::move(ray), 0, to);
}

// The last secondary rays of a bundle; those that miss a cell wait for it.
void PyramidTask::traceSecondaries(RayBundle& from) {
  bundle_.clear();
  from.moveLast(std::min(from.size(), kBundleSize), bundle_);
  unit_.trace(
      bundle_.rays, bundle_.begin, bundle_.to,
      [this](Ray&& ray, const ReplyTo& to) { goOn(std::move(ray), to); },
      [this](std::size_t i, const NextBlock& next) {
        unit_.cells.want(next.cell);
        waitingForCell_[static_cast<std::uint32_t>(next.cell)].add(std::move(bundle_.rays[i]), next.tEnter,
                                                                   bundle_.to[i]);
      });
}

}  // namespace rayshade
