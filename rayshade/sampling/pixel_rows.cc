// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/sampling/pixel_rows.h"

#include <stdexcept>

#include "rayshade/sampling/filter.h"

namespace rayshade {
namespace {

// The cell of a pixel's first sample has a key of its own, apart from those of the cells.
constexpr std::uint32_t kNoCell = 0xffffffffu;

}  // namespace

SamplingRules samplingRules(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame) {
  const auto area = pixelArea(spec);
  if (!area)
    throw std::invalid_argument("the window is not on the screen, or the screen is empty or too large");
  const std::int32_t side = spec.samplesPerSide;
  if (side < 1 || side > kMaxSamplesPerSide)
    throw std::invalid_argument("there must be 1 to 8 samples per side of a pixel");
  const bool refining = side > 1 && area->width > 2 && area->height > 2;
  return {*area,
          side,
          seed,
          frame,
          spec.contrast,
          filterWeights(spec.filter, side),
          ~std::uint64_t{0} >> (64 - side * side),
          refining,
          area->height + (refining ? 1 : 0)};
}

void PixelRows::demandAll(Row& row, Pixel& pixel) {
  pixel.full = true;
  if (!isWhole(pixel)) ++row.incomplete;
  const bool firstCounted = (pixel.given & pixel.firstBit()) != 0;
  counts.needed += static_cast<std::uint64_t>(rules_.side * rules_.side - firstCounted);
  if (rules_.side > 1) ++counts.supersampled;
}

void PixelRows::add() {
  const PixelArea& area = rules_.area;
  const std::int32_t cells = rules_.side * rules_.side, y = end();
  Row& row = rows_.emplace_back();
  if (!spare_.empty()) {
    row.pixels = std::move(spare_.back());
    spare_.pop_back();
  }
  row.pixels.clear();
  row.pixels.resize(static_cast<std::size_t>(area.width));
  for (std::int32_t x = 0; x < area.width; ++x) {
    const bool side = x == 0 || x == area.width - 1, end = y == 0 || y == area.height - 1;
    if (y < area.height && (side || end || !rules_.refining)) {
      demandAll(row, row.pixels[static_cast<std::size_t>(x)]);
    } else if (!side) {
      ++counts.needed;
      if (cells == 1) continue;
      const RandomKey key = sampleKey(rules_.seed, rules_.frame, static_cast<std::uint32_t>(area.x + x),
                                      static_cast<std::uint32_t>(area.y + y), kNoCell);
      row.pixels[static_cast<std::size_t>(x)].firstCell =
          static_cast<std::uint8_t>(uniform(key, Dimension::firstCell) * cells);
    }
  }
}

std::optional<Place> PixelRows::supply(const SampleId& id, Color color) {
  const std::int32_t side = rules_.side;
  const std::int64_t x = std::int64_t{id.x} - rules_.area.x, y = std::int64_t{id.y} - rules_.area.y;
  if (x < 0 || x >= rules_.area.width || y < first_ || y >= end() || id.cell < 0 || id.cell >= side * side)
    return std::nullopt;
  const Place place{static_cast<std::int32_t>(y), static_cast<std::int32_t>(x)};
  Row& row = rowOf(place);
  Pixel& pixel = row.pixels[static_cast<std::size_t>(x)];
  const std::uint64_t bit = std::uint64_t{1} << id.cell;
  if ((pixel.given & bit) == 0 || (pixel.come & bit) != 0) return std::nullopt;
  pixel.come |= bit;
  // The optics sees to it that this never happens (shading/combine.cc).
  if (!isFinite(color)) {
    color = kBlack;
    ++counts.notFinite;
  }

  if (side == 1) {
    pixel.first = color * rules_.weights[0];
  } else if (id.cell == pixel.firstCell) {
    pixel.first = color;
  } else {
    if (!pixel.samples) pixel.samples = std::make_unique<Color[]>(rules_.weights.size());
    pixel.samples[static_cast<std::size_t>(id.cell)] = color;
  }
  if (!isWhole(pixel)) return id.cell == pixel.firstCell ? std::optional(place) : std::nullopt;
  if (side > 1) {
    const Color whole = filtered(pixel);
    pixel.samples = std::make_unique<Color[]>(1);
    pixel.samples[0] = whole;
  }
  if (pixel.full) --row.incomplete;
  return place;
}

// Always added in the same order: the first sample, then the others by cell.
Color PixelRows::filtered(const Pixel& pixel) const {
  const std::vector<double>& weights = rules_.weights;
  Color sum = pixel.first * weights[pixel.firstCell];
  for (std::size_t cell = 0; cell < weights.size(); ++cell)
    if (cell != pixel.firstCell) sum = sum + pixel.samples[cell] * weights[cell];
  return sum;
}

bool PixelRows::takeFirst(std::vector<Color>& colors) {
  if (rows_.empty() || rows_.front().incomplete != 0) return false;
  colors.clear();
  for (const Pixel& pixel : rows_.front().pixels) colors.push_back(pixel.full ? pixel.whole() : pixel.first);
  spare_.push_back(std::move(rows_.front().pixels));
  rows_.pop_front();
  ++first_;
  return true;
}

}  // namespace rayshade
