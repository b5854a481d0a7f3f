// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/sampling/pixel_rows.h"

#include <stdexcept>

#include "rayshade/sampling/filter.h"

namespace rayshade {
namespace {

// The cell of a pixel's first sample has a key of its own, apart from those of the cells.
constexpr std::uint32_t kNoCell = 0xffffffffu;

std::uint64_t keyOf(Place place) {
  return static_cast<std::uint64_t>(place.y) << 32 | static_cast<std::uint32_t>(place.x);
}

// Always added in the same order: the first sample, then the others by cell.
Color filtered(const std::vector<double>& weights, std::size_t firstCell, Color first,
               const std::vector<Color>& colors) {
  Color sum = first * weights[firstCell];
  for (std::size_t cell = 0; cell < weights.size(); ++cell)
    if (cell != firstCell) sum = sum + colors[cell] * weights[cell];
  return sum;
}

}  // namespace

SamplingRules samplingRules(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame) {
  const auto area = pixelArea(spec);
  if (!area)
    throw std::invalid_argument("the window is not on the screen, or the screen is empty or too large");
  const std::int32_t side = spec.samplesPerSide;
  if (side < 1 || side > kMaxSamplesPerSide)
    throw std::invalid_argument("there must be 1 to 8 samples per side of a pixel");
  const bool refining = side > 1 && area->width > 2 && area->height > 2;
  return {*area,         side,
          seed,          frame,
          spec.contrast, filterWeights(spec.filter, side),
          refining,      area->height + (refining ? 1 : 0)};
}

// Row 0, the last row and the first and last column get all of their samples; the line below the picture (sampler.cc) one
// for each pixel, and none at its two ends.
Asked askedOf(const SamplingRules& rules, Place place) {
  const PixelArea& area = rules.area;
  const bool side = place.x == 0 || place.x == area.width - 1;
  if (place.y == area.height) return side ? Asked::nothing : Asked::first;
  if (rules.side == 1) return Asked::first;
  const bool end = place.y == 0 || place.y == area.height - 1;
  return side || end || !rules.refining ? Asked::all : Asked::first;
}

std::int32_t firstCell(const SamplingRules& rules, Place place) {
  if (rules.side == 1 || askedOf(rules, place) == Asked::all) return 0;
  const RandomKey key = sampleKey(rules.seed, rules.frame, static_cast<std::uint32_t>(rules.area.x + place.x),
                                  static_cast<std::uint32_t>(rules.area.y + place.y), kNoCell);
  return static_cast<std::int32_t>(uniform(key, Dimension::firstCell) * rules.cells());
}

void PixelRows::add() {
  const std::int32_t y = end();
  Row& row = rows_.emplace_back();
  if (!spare_.empty()) {
    row = std::move(spare_.back());
    spare_.pop_back();
  }
  const auto width = static_cast<std::size_t>(width_);
  row.first.resize(width);
  if (rules_.side > 1) row.whole.resize(width);
  row.flags.assign(width, 0);
  row.incomplete = width_;
  for (std::int32_t x = left_; x < right(); ++x) {
    const Asked asked = askedOf(rules_, {y, x});
    counts.needed += asked == Asked::first;
    if (asked == Asked::all) demandAll({y, x});
  }
}

bool PixelRows::demandAll(Place place) {
  Row& row = this->row(place.y);
  std::uint8_t& flags = row.flags[column(place)];
  if ((flags & kFull) != 0) return false;
  const bool firstCounted = askedOf(rules_, place) == Asked::first;
  counts.needed += static_cast<std::uint64_t>(rules_.cells() - firstCounted);
  ++counts.supersampled;
  const bool wasKnown = (flags & kFirst) != 0, isKnown = (flags & kWhole) != 0;
  row.incomplete += wasKnown - isKnown;
  flags |= kFull;
  return !isKnown;
}

// The optics sees to it that this is never needed (shading/combine.cc).
Color PixelRows::finite(Color color) {
  if (isFinite(color)) return color;
  ++counts.notFinite;
  return kBlack;
}

void PixelRows::supplyFirst(Place place, Color color) {
  Row& row = this->row(place.y);
  std::uint8_t& flags = row.flags[column(place)];
  if ((flags & kFirst) != 0) return;
  row.first[column(place)] = finite(color) * (rules_.side == 1 ? rules_.weights[0] : 1.0);
  row.incomplete -= (flags & kFull) == 0;
  flags |= kFirst;
}

void PixelRows::supplyWhole(Place place, Color color) {
  Row& row = this->row(place.y);
  std::uint8_t& flags = row.flags[column(place)];
  if ((flags & kWhole) != 0) return;
  row.whole[column(place)] = color;
  row.incomplete -= (flags & kFull) != 0;
  flags |= kWhole;
}

bool PixelRows::supply(const SampleId& id, Color color) {
  const std::int64_t x = std::int64_t{id.x} - rules_.area.x, y = std::int64_t{id.y} - rules_.area.y;
  if (x < left_ || x >= right() || y < first_ || y >= end() || id.cell < 0 || id.cell >= rules_.cells())
    return false;
  const Place place{static_cast<std::int32_t>(y), static_cast<std::int32_t>(x)};
  const std::int32_t first = firstCell(rules_, place);
  const std::uint64_t bit = std::uint64_t{1} << id.cell;
  if (isWhole(place)) return false;
  if (id.cell == first) {
    if (has(place, kFirst)) return false;
    supplyFirst(place, color);
    if (rules_.side == 1 || !isFull(place)) return true;
  }
  Cells& cells = come_[keyOf(place)];
  cells.colors.resize(rules_.weights.size());
  if (id.cell != first) {
    if ((cells.come & bit) != 0) return false;
    cells.come |= bit;
    cells.colors[static_cast<std::size_t>(id.cell)] = finite(color);
  }
  if (!has(place, kFirst) || std::popcount(cells.come) + 1 < rules_.cells()) return true;
  supplyWhole(place, filtered(rules_.weights, static_cast<std::size_t>(first),
                              row(place.y).first[column(place)], cells.colors));
  come_.erase(keyOf(place));
  return true;
}

bool PixelRows::takeFirst(std::vector<Color>& colors) {
  if (rows_.empty() || rows_.front().incomplete != 0) return false;
  Row& row = rows_.front();
  colors = row.first;
  for (std::size_t x = 0; x < row.flags.size(); ++x)
    if ((row.flags[x] & kFull) != 0) colors[x] = row.whole[x];
  spare_.push_back(std::move(row));
  rows_.pop_front();
  ++first_;
  return true;
}

}  // namespace rayshade
