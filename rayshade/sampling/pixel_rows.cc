// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/sampling/pixel_rows.h"

#include <algorithm>
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

namespace {

Refinement refinementOf(const PictureSpec& spec) {
  if (spec.samplesPerSide == 1 || spec.contrast == kBlack) return Refinement::all;
  const bool tiny = spec.width <= 2 || spec.height <= 2;  // no cross has its middle there
  return tiny && spec.refinement == Refinement::crosses ? Refinement::all : spec.refinement;
}

// What decides about the pixels that are wanted: one more on each side.
// differs from rayshade4: the border of a window is none of the picture; and without contrast all pixels get all samples.  Crosses depend on all that were swept before them: on
// all lines above, and as the line below is swept, on two more.
PixelArea sampledArea(const PixelArea& wanted, const PictureSpec& spec, Refinement refinement) {
  const std::int32_t right = wanted.x + wanted.width, bottom = wanted.y + wanted.height;
  switch (refinement) {
    case Refinement::crosses:
      return {0, 0, spec.width, std::min(bottom + 2, spec.height)};
    case Refinement::neighbours: {
      const std::int32_t x = std::max(wanted.x - 1, 0), y = std::max(wanted.y - 1, 0);
      return {x, y, std::min(right + 1, spec.width) - x, std::min(bottom + 1, spec.height) - y};
    }
    case Refinement::all:
      break;
  }
  return wanted;
}

}  // namespace

SamplingRules samplingRules(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame) {
  const auto wanted = pixelArea(spec);
  if (!wanted)
    throw std::invalid_argument("the window is not on the screen, or the screen is empty or too large");
  SamplingRules rules;
  rules.side = spec.samplesPerSide;
  if (rules.side < 1 || rules.side > kMaxSamplesPerSide)
    throw std::invalid_argument("too many samples per side of a pixel, or none");
  rules.refinement = refinementOf(spec);
  rules.area = sampledArea(*wanted, spec, rules.refinement);
  rules.wanted = {wanted->x - rules.area.x, wanted->y - rules.area.y, wanted->width, wanted->height};
  rules.screen = {-rules.area.x, -rules.area.y, spec.width, spec.height};
  rules.seed = seed;
  rules.frame = frame;
  rules.contrast = spec.contrast;
  // Samples that are dense where the filter weighs much weigh the same (sample_position.cc).
  const bool equal = spec.sampling == Sampling::nets && spec.jitter;
  rules.weights = filterWeights(equal ? PixelFilter{} : spec.filter, rules.side);
  const bool toTheBottom = wanted->y + wanted->height + 2 > spec.height;
  rules.rowCount = rules.area.height + (rules.refinement == Refinement::crosses && toTheBottom ? 1 : 0);
  return rules;
}

// Crosses: row 0, the last row and the first and last column of the screen get all of their samples; the line below the picture
// (sampler.cc) one for each pixel, and none at its two ends.
Asked askedOf(const SamplingRules& rules, Place place) {
  if (rules.side == 1 || rules.refinement == Refinement::neighbours) return Asked::first;
  if (!rules.refining()) return Asked::all;
  const PixelArea& screen = rules.screen;  // the area begins where it does
  const bool side = place.x == 0 || place.x == screen.width - 1;
  if (place.y == screen.height) return side ? Asked::nothing : Asked::first;
  return side || place.y == 0 || place.y == screen.height - 1 ? Asked::all : Asked::first;
}

std::uint64_t pixelsAskedForAll(const SamplingRules& rules) {
  const auto width = static_cast<std::uint64_t>(rules.area.width),
             height = static_cast<std::uint64_t>(rules.area.height);
  if (rules.refinement == Refinement::neighbours) return 0;
  if (!rules.refining()) return width * height;
  const std::uint64_t lines = rules.area.height == rules.screen.height ? 2 : 1;
  return lines * width + 2 * (height - lines);
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
  if (isWhole(place)) return false;
  if (id.cell == first) {
    if (has(place, kFirst)) return false;
    supplyFirst(place, color);
    if (rules_.side == 1 || !isFull(place)) return true;
  }
  Cells& cells = come_[keyOf(place)];
  cells.colors.resize(rules_.weights.size());
  cells.come.resize(rules_.weights.size());
  if (id.cell != first) {
    const auto cell = static_cast<std::size_t>(id.cell);
    if (cells.come[cell]) return false;
    cells.come[cell] = true;
    ++cells.count;
    cells.colors[cell] = finite(color);
  }
  if (!has(place, kFirst) || cells.count + 1 < rules_.cells()) return true;
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
