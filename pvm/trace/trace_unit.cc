// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/trace_unit.h"

namespace rayshade {

void TraceUnit::begin(TaskId host, Configure&& message, std::uint32_t cluster, std::uint32_t finder) {
  at = {std::move(message.settings),
        std::move(message.tree),
        std::move(message.directory),
        cluster,
        message.exposure,
        message.policy,
        std::move(message.request),
        std::move(message.cellBytes)};
  rules = samplingRules(at.request.picture, at.request.seed, static_cast<std::uint32_t>(at.exposure.frame));
  tiles.clear();
  asked_ = 0;
  waitingForCell_.clear();
  cells.begin();
  space.begin(message.cellBounds, context.link.self());
  shades.begin(finder);
  replies.begin(host);
  shadows.begin();
}

// Open hits wait here, or at a shade task if light is still to come.
void TraceUnit::traceTrees(std::span<Ray> rays, std::span<const double> begin, std::span<const ReplyTo> to) {
  open_.clear();
  Color seen[kBundleSize];
  const std::uint64_t hitsBefore = counts.hits;
  const RaySet unknown = tracer.trace(rays, begin, seen, open_);
  replies.countCombined(counts.hits - hitsBefore - open_.hits.size());
  for (std::size_t i = 0; i < rays.size(); ++i)
    if ((unknown >> i & 1) == 0) replies.answer(to[i], seen[i]);

  replyOf_.resize(open_.hits.size());
  const auto slotOf = [](ReplyTo hit, OpenEnds::Branch branch) {
    hit.slot = branch == OpenEnds::Branch::transmitted ? kTransmittedSlot : kReflectedSlot;
    return hit;
  };
  const auto replyTo = [&](const OpenEnds::Waiting& waiting) {
    return waiting.hit == OpenEnds::kBundle ? to[waiting.ray] : slotOf(replyOf_[waiting.hit], waiting.branch);
  };
  for (std::size_t h = open_.hits.size(); h-- > 0;) {
    OpenEnds::OpenHit& hit = open_.hits[h];
    const ReplyTo up = replyTo(hit.to);
    if (hit.unlit == OpenEnds::kLit) {
      replyOf_[h] = replies.await(hit.sum, hit.back, up);
    } else {
      OpenEnds::UnlitHit& unlit = open_.unlit[hit.unlit];
      replyOf_[h] = shader.handOver(unlit.light, unlit.ray, hit.back, up);
    }
    if (hit.transmitted) replies.answer(slotOf(replyOf_[h], OpenEnds::Branch::transmitted), *hit.transmitted);
    if (hit.reflected) replies.answer(slotOf(replyOf_[h], OpenEnds::Branch::reflected), *hit.reflected);
  }
  for (OpenEnds::OpenRay& open : open_.rays) goOn(std::move(open.ray), open.next, replyTo(open.to));
}

// A ray that needs what is not here: it waits if the cell is worth fetching or on its way, else it travels.
void TraceUnit::goOn(Ray&& ray, const NextBlock& next, const ReplyTo& to) {
  if (fetchesForRays && cells.missed(next.cell, 1, !at.policy.secondariesTravel)) {
    waitingForCell_[static_cast<std::uint32_t>(next.cell)].add(std::move(ray), next.tEnter, to);
    return;
  }
  ++travelling_;
  replies.forward(at.ownerOf(next.voxel), std::move(ray), next.step, to);
}

RayBundle TraceUnit::arrive(CellId cell) {
  shadows.resume(cell);
  tiles.arrive(cell);
  const auto waiting = waitingForCell_.find(static_cast<std::uint32_t>(cell));
  if (waiting == waitingForCell_.end()) return {};
  RayBundle rays = std::move(waiting->second);
  waitingForCell_.erase(waiting);
  return rays;
}

void TraceUnit::wantTiles(TaskId host, std::size_t most) {
  for (; tiles.size() + asked_ < most; ++asked_) context.outbox.post(host, PyramidWanted{});
}

void TraceUnit::sendTiles(TaskId host) {
  while (std::optional<TilesInHand::FinishedTile> tile = tiles.takeFinished()) {
    ++pyramids;
    pyramidRays += tile->colors.samples;
    context.outbox.post(host, TileDone{tile->number, std::move(tile->colors)});
  }
}

void TraceUnit::giveOn(const CellWanted& message) {
  if (static_cast<std::size_t>(message.cell) >= cellCount(at.tree) ||
      !isTracer(at.directory, message.asker)) {
    ++context.outbox.traffic.refused;
    return;
  }
  std::optional<std::vector<Item>> items = cache.itemsOf(message.cell);
  if (items) {
    ++cellsServed;
    context.outbox.post(message.asker, CellItems{message.cell, std::move(*items)});
  } else {
    context.outbox.post(at.ownerOf(voxelOfCell(at.tree, message.cell)), message);
  }
}

void TraceUnit::setWeights(const Weights& message) {
  if (message.epoch == context.epoch && message.shadeWeights.size() == at.directory.shadeTasks.size())
    at.directory.shadeWeights = message.shadeWeights;
}

void TraceUnit::addTo(Report& report) const {
  report.counts = counts;
  report.combined = replies.combined();
  report.cache = cache.counts();
  report.shadowCache = space.shadowLookups();
  report.cellsServed = cellsServed;
  report.pyramids = pyramids;
  report.pyramidRays = pyramidRays;
  report.forwardedRays = forwardedRays;
}

}  // namespace rayshade
