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
  cells.begin();
  space.begin(message.cellBounds, context.link.self());
  shades.begin(finder);
  replies.begin(host);
  shadows.begin();
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
}

}  // namespace rayshade
