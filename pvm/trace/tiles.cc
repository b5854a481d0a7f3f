// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/tiles.h"

#include "rayshade/space/walk.h"

namespace rayshade {
namespace {

// The record of a sample: tile, pixel and cell.
constexpr int kCellBits = 12, kPixelBits = 16;
static_assert(kMaxSamplesPerSide * kMaxSamplesPerSide <= 1 << kCellBits &&
              kMostTilePixels <= 1 << kPixelBits);

// The first samples of a tile: what a lens sees is not one pyramid.
std::vector<CellId> cellsOfLens(const BinTree& tree, const FrameRequest& request, const SamplingRules& rules,
                                const Tile& tile, std::int32_t frame) {
  std::vector<SampleId> samples;
  for (std::int32_t y = tile.y; y < tile.y + tile.height; ++y)
    for (std::int32_t x = tile.x; x < tile.x + tile.width; ++x)
      samples.push_back(sampleAt(rules, {y, x}, firstCell(rules, {y, x})));
  std::vector<Ray> rays;
  primaryRays(request.view, request.picture, request.seed, frame, samples, rays);
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

}  // namespace

std::vector<CellId> cellsOf(const BinTree& tree, const FrameRequest& request, const SamplingRules& rules,
                            const Tile& tile, std::int32_t frame) {
  const View& view = request.view;
  if (view.lensRight != Vec3{} || view.lensUp != Vec3{})
    return cellsOfLens(tree, request, rules, tile, frame);
  // Half a filter around the places of pixels, and a little more: a pyramid of one ray is none.
  const double margin = request.picture.filter.width / 2 + 1e-3;
  const double u0 = rules.area.x + tile.x - margin, u1 = u0 + tile.width - 1 + 2 * margin;
  const double v0 = rules.area.y + tile.y - margin, v1 = v0 + tile.height - 1 + 2 * margin;
  const auto corner = [&](double u, double v) { return view.first + u * view.right + v * view.down; };
  return clipList(tree,
                  pyramidOf(view.eye, {corner(u0, v0), corner(u1, v0), corner(u1, v1), corner(u0, v1)}));
}

void TilesInHand::add(std::uint32_t number, TileSampler&& sampler, std::span<const CellId> awaited) {
  tiles_.emplace(number, OpenTile{std::move(sampler), awaited.size()});
  for (const CellId cell : awaited) byCell_[static_cast<std::uint32_t>(cell)].push_back(number);
}

void TilesInHand::arrive(CellId cell) {
  const auto waiting = byCell_.find(static_cast<std::uint32_t>(cell));
  if (waiting == byCell_.end()) return;
  for (const std::uint32_t number : waiting->second) --tiles_.at(number).missing;
  byCell_.erase(waiting);
}

std::size_t TilesInHand::next(std::span<SampleId> samples, std::span<RecordId> records) {
  for (auto& [number, open] : tiles_) {
    if (open.missing > 0) continue;
    const std::size_t count = open.sampler.next(samples);
    const PixelArea& area = open.sampler.rules().area;
    const Tile& tile = open.sampler.tile();
    for (std::size_t i = 0; i < count; ++i) {
      const SampleId& s = samples[i];
      const auto pixel = static_cast<RecordId>((s.y - area.y - tile.y) * tile.width + s.x - area.x - tile.x);
      records[i] = (RecordId{number} << kPixelBits | pixel) << kCellBits | static_cast<RecordId>(s.cell);
    }
    if (count > 0) return count;
  }
  return 0;
}

bool TilesInHand::supply(RecordId record, Color color) {
  const RecordId number = record >> (kPixelBits + kCellBits);
  const auto found = tiles_.find(static_cast<std::uint32_t>(number));
  if (number > 0xffffffffu || found == tiles_.end()) return false;
  TileSampler& sampler = found->second.sampler;
  const Tile& tile = sampler.tile();
  const auto pixel = static_cast<std::int32_t>(record >> kCellBits & ((1 << kPixelBits) - 1));
  if (pixel >= tile.width * tile.height) return false;
  const Place place{tile.y + pixel / tile.width, tile.x + pixel % tile.width};
  const auto cell = static_cast<std::int32_t>(record & ((1 << kCellBits) - 1));
  if (!sampler.supply(sampleAt(sampler.rules(), place, cell), color)) return false;
  if (sampler.finished()) finished_.push_back(found->first);
  return true;
}

std::optional<TilesInHand::FinishedTile> TilesInHand::takeFinished() {
  if (finished_.empty()) return std::nullopt;
  const auto found = tiles_.find(finished_.front());
  finished_.pop_front();
  FinishedTile finished{found->first, found->second.sampler.colors()};
  tiles_.erase(found);
  return finished;
}

}  // namespace rayshade
