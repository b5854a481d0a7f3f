// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/pyramid_task.h"

#include <algorithm>

#include "rayshade/base/arithmetic.h"
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
  rays_.clear();
  const std::uint32_t cluster = *place % message.directory.clusters;
  const auto finder = static_cast<std::uint32_t>(message.directory.voxelTasks.size()) + *place;
  unit_.begin(from, std::move(message), cluster, finder);
  unit_.fetchesForRays = true;
  context_.outbox.post(from, Ready{context_.epoch, arithmeticFingerprint(), 0, 0, 0});
}

Report PyramidTask::counted() const {
  Report report = context_.counted();
  unit_.addTo(report);
  report.modelBytes = report.cache.peakBytes;
  return report;
}

void PyramidTask::on(TaskId from, Finish) {
  context_.close();
  context_.outbox.post(from, context_.closed(counted()));
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

// How many cells of a list are fetched; any number gives the same picture.  What does not fit with what other tiles wait for is
// left to the rays that come to it.
std::size_t PyramidTask::beforeHorizon(std::span<const CellId> cells, std::size_t rays) const {
  const EpochSettings& at = unit_.at;
  const Horizon& horizon = at.policy.horizon;
  std::size_t n = 0;
  if (horizon.kind == Horizon::Kind::cells) {
    n = static_cast<std::size_t>(std::min(horizon.value, static_cast<double>(cells.size())));
  } else if (horizon.kind == Horizon::Kind::distance) {
    while (n < cells.size() && distanceTo(boundsOf(at.tree, cells[n]), at.request.view.eye) <= horizon.value)
      ++n;
  } else {
    n = cells.size();
  }
  return unit_.cells.worthAsking(cells.first(n), rays, horizon.kind != Horizon::Kind::automatic,
                                 static_cast<double>(at.policy.cacheBytes) / TraceUnit::kAhead);
}

void PyramidTask::on(TaskId, TileWork message) {
  const SamplingRules& rules = *unit_.rules;
  const Tile& tile = message.tile;
  if (!fits(tile, rules) || unit_.tiles.has(message.number)) {
    ++context_.outbox.traffic.refused;
    return;
  }
  std::vector<CellId> cells = cellsOf(unit_.at.tree, unit_.at.request, rules, tile, unit_.at.exposure.frame);
  cells.resize(beforeHorizon(cells, static_cast<std::size_t>(tile.width * tile.height)));
  std::erase_if(cells, [this](CellId cell) { return unit_.cells.isHere(cell); });
  unit_.tiles.add(message.number, TileSampler(rules, tile), cells);
  unit_.noteWork();
  for (const CellId cell : cells) unit_.cells.want(cell);
  context_.notePeak(unit_.tiles.size() + unit_.shadows.waiting());
}

// Samples that no tile has traced.
void PyramidTask::on(TaskId from, PrimaryRays message) {
  if (!samplesFit(message, unit_.at.request.picture)) {
    ++context_.outbox.traffic.refused;
    return;
  }
  for (std::size_t i = message.samples.size(); i-- > 0;)
    rays_.add(primaryRay(unit_.at.request, unit_.at.exposure, message.samples[i]), 0,
              {from, message.firstRecord + i, 0});
  unit_.counts.primaryRays += message.samples.size();
  unit_.noteWork();
}

void PyramidTask::on(TaskId, const Answer& message) {
  unit_.replies.answer({context_.link.self(), message.record, message.slot}, message.color);
}

void PyramidTask::on(TaskId, CellItems message) {
  const CellId cell = message.cell;
  if (!unit_.images.fill(message.items) || !unit_.cells.arrive(std::move(message))) {
    ++context_.outbox.traffic.refused;
    return;
  }
  for (RayBundle rays = unit_.arrive(cell); !rays.empty();) traceWaiting(rays);
}

// ---- rays

bool PyramidTask::work(double until) {
  const TaskContext::Doing doing(context_, EventKind::trace);
  while (traceSome())
    if (context_.link.now() >= until) return true;
  return false;
}

bool PyramidTask::traceSome() {
  unit_.space.settle();
  bool any = !rays_.empty();
  if (any) {
    traceWaiting(rays_);
  } else {
    any = unit_.traceTile([this](Ray&& ray, const ReplyTo& to) { queue(std::move(ray), to); });
  }
  unit_.sendTiles(host_);
  unit_.wantTiles(host_);
  return any;
}

// The last rays of a bundle.
void PyramidTask::traceWaiting(RayBundle& from) {
  bundle_.clear();
  from.moveLast(std::min(from.size(), kBundleSize), bundle_);
  unit_.trace(bundle_.rays, bundle_.begin, bundle_.to,
              [this](Ray&& ray, const ReplyTo& to) { queue(std::move(ray), to); });
}

// A ray that begins at a hit: to the voxel where it begins, or into the own queue.
void PyramidTask::queue(Ray&& ray, const ReplyTo& to) {
  if (objectsTravel()) {
    rays_.add(std::move(ray), 0, to);
    return;
  }
  VoxelWalk walk(unit_.at.tree, ray.origin, ray.direction);
  WalkStep<VoxelId> first;
  walk.next(first);
  unit_.replies.forward(unit_.at.ownerOf(first.where), std::move(ray), 0, to);
}

}  // namespace rayshade
