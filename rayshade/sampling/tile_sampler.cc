// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/sampling/tile_sampler.h"

#include <algorithm>
#include <functional>

namespace rayshade {
namespace {

constexpr std::int32_t kBlock = 8;  // pixels: the side of a block of first samples

}  // namespace

bool fit(const TileColors& colors, const Tile& tile) {
  const std::size_t pixels = static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
  return colors.first.size() == pixels && colors.full.size() == colors.whole.size() &&
         (colors.full.empty() || colors.full.back() < pixels) &&
         std::ranges::is_sorted(colors.full, std::less_equal<>{});
}

TileSampler::TileSampler(const SamplingRules& rules, const Tile& tile)
    : tile_(tile),
      rows_(rules, tile.x, tile.width, tile.y),
      sweep_(rows_, tile.y + tile.height),
      begin_{tile.y, tile.x} {
  for (std::int32_t y = 0; y < tile.height; ++y) rows_.add();
  skipUnasked();
}

std::size_t TileSampler::next(std::span<SampleId> out) {
  if (allBegun()) sweep_.decide(rows_, demanded_);
  std::size_t count = 0;
  while (count < out.size() && give(out[count])) ++count;
  given_ += static_cast<std::uint32_t>(count);
  awaited_ += static_cast<std::uint32_t>(count);
  return count;
}

bool TileSampler::give(SampleId& out) {
  const SamplingRules& rules = rows_.rules();
  if (!allBegun()) return giveBegin(out);
  if (demanded_.empty()) return false;
  const Place place = demanded_.front();
  const std::int32_t first = firstCell(rules, place);
  cell_ += cell_ == first;
  out = sampleAt(rules, place, cell_++);
  cell_ += cell_ == first;
  if (cell_ < rules.cells()) return true;
  demanded_.pop_front();
  cell_ = 0;
  return true;
}

bool TileSampler::giveBegin(SampleId& out) {
  const SamplingRules& rules = rows_.rules();
  const bool all = askedOf(rules, begin_) == Asked::all;
  out = sampleAt(rules, begin_, all ? cell_++ : firstCell(rules, begin_));
  if (all && cell_ < rules.cells()) return true;
  cell_ = 0;
  stepBegin();
  skipUnasked();
  return true;
}

void TileSampler::skipUnasked() {
  while (!allBegun() && askedOf(rows_.rules(), begin_) == Asked::nothing) stepBegin();
}

void TileSampler::stepBegin() {
  const std::int32_t right = tile_.x + tile_.width, bottom = tile_.y + tile_.height;
  const std::int32_t x = begin_.x - tile_.x, y = begin_.y - tile_.y;
  const std::int32_t block = tile_.x + x / kBlock * kBlock, blockEnd = std::min(block + kBlock, right);
  const std::int32_t band = tile_.y + y / kBlock * kBlock, bandEnd = std::min(band + kBlock, bottom);
  if (++begin_.x < blockEnd) return;
  begin_.x = block;
  if (++begin_.y < bandEnd) return;
  begin_ = blockEnd < right ? Place{band, blockEnd} : Place{bandEnd, tile_.x};
}

bool TileSampler::supply(const SampleId& id, Color color) {
  if (awaited_ == 0 || !rows_.supply(id, color)) return false;
  if (--awaited_ == 0 && allBegun()) sweep_.decide(rows_, demanded_);
  return true;
}

TileColors TileSampler::colors() const {
  TileColors colors;
  colors.samples = given_;
  colors.notFinite = static_cast<std::uint32_t>(rows_.counts.notFinite);
  colors.first.reserve(static_cast<std::size_t>(tile_.width) * static_cast<std::size_t>(tile_.height));
  for (std::int32_t y = tile_.y; y < tile_.y + tile_.height; ++y)
    for (std::int32_t x = tile_.x; x < tile_.x + tile_.width; ++x) {
      if (rows_.isWhole({y, x})) {
        colors.full.push_back(static_cast<std::uint32_t>(colors.first.size()));
        colors.whole.push_back(rows_.whole({y, x}));
      }
      colors.first.push_back(rows_.first({y, x}));
    }
  return colors;
}

}  // namespace rayshade
