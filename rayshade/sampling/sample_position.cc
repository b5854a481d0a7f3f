// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/sampling/sample_position.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "rayshade/sampling/filter.h"

namespace rayshade {
namespace {

// Magic squares and the like by column + row * side; facts of rayshade 4.
constexpr std::uint8_t kNumbers1[] = {0};
constexpr std::uint8_t kNumbers2[] = {0, 2, 3, 1};
constexpr std::uint8_t kNumbers3[] = {0, 2, 7, 6, 5, 1, 3, 8, 4};
constexpr std::uint8_t kNumbers4[] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
constexpr std::uint8_t kNumbers5[] = {0, 8, 23, 17, 2,  19, 12, 4,  20, 15, 3,  21, 16,
                                      9, 6, 14, 10, 24, 1,  13, 22, 7,  18, 11, 5};
constexpr std::uint8_t kNumbers6[] = {6,  32, 3,  34, 35, 1,  7,  11, 27, 28, 8,  30, 24, 14, 16, 15, 23, 19,
                                      13, 20, 22, 21, 17, 18, 25, 29, 10, 9,  26, 12, 36, 5,  33, 4,  2,  31};
constexpr std::uint8_t kNumbers7[] = {22, 47, 16, 41, 10, 35, 4,  5,  23, 48, 17, 42, 11, 29, 30, 6,  24,
                                      49, 18, 36, 12, 13, 31, 7,  25, 43, 19, 37, 38, 14, 32, 1,  26, 44,
                                      20, 21, 39, 8,  33, 2,  27, 45, 46, 15, 40, 9,  34, 3,  28};
constexpr std::uint8_t kNumbers8[] = {8,  58, 59, 5,  4,  62, 63, 1,  49, 15, 14, 52, 53, 11, 10, 56,
                                      41, 23, 22, 44, 45, 19, 18, 48, 32, 34, 35, 29, 28, 38, 39, 25,
                                      40, 26, 27, 37, 36, 30, 31, 33, 17, 47, 46, 20, 21, 43, 42, 24,
                                      9,  55, 54, 12, 13, 51, 50, 16, 64, 2,  3,  61, 60, 6,  7,  57};
constexpr std::span<const std::uint8_t> kNumbers[] = {kNumbers1, kNumbers2, kNumbers3, kNumbers4,
                                                      kNumbers5, kNumbers6, kNumbers7, kNumbers8};

}  // namespace

// Beyond those of rayshade: multiples of the golden section, in one direction or the other the next that has no common divisor
// with the number of samples.
std::int32_t sampleNumber(std::int32_t side, std::int32_t cell) {
  if (side <= std::ssize(kNumbers)) return kNumbers[side - 1][static_cast<std::size_t>(cell)];
  const std::int32_t cells = side * side;
  std::int32_t step = static_cast<std::int32_t>(0.618 * cells);
  while (std::gcd(step, cells) != 1) ++step;
  return static_cast<std::int32_t>(std::int64_t{step} * cell % cells);
}

namespace {

// From [0, 1) to the columns of cells of a pixel (its rows alike), each met as often as the filter weighs it.  So samples are
// dense where they count, and all weigh the same.
class Columns {
 public:
  Columns(const PixelFilter& filter, std::int32_t side) : side_(side) {
    if (!filter.gaussian) return;
    double total = 0;
    for (std::int32_t column = 0; column < side; ++column)
      bounds_[static_cast<std::size_t>(column) + 1] = total += columnWeight(filter, side, column);
    weighted_ = total > 0;
    for (double& bound : bounds_) bound /= total;
  }
  double operator()(double x) const {
    if (!weighted_) return x;
    std::size_t column = 0;
    while (column + 1 < static_cast<std::size_t>(side_) && x >= bounds_[column + 1]) ++column;
    const double low = bounds_[column], high = bounds_[column + 1];
    return (static_cast<double>(column) + (x - low) / (high - low)) / side_;
  }

 private:
  std::int32_t side_;
  bool weighted_ = false;
  std::array<double, kMaxSamplesPerSide + 1> bounds_{};
};

// What the samples of a frame have in common.
// differs from rayshade4: samples are points of a net unless strata are asked for (sample_plan.h).
struct SampleGrid {
  SamplePlan plan;
  bool jitter;
  double width;           // of the filter                                                          [pixels]
  double opens, shutter;  // shutter 0: all samples are taken when it opens                     [scene time]
  RandomKey key;
  Columns columns;

  SampleGrid(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame)
      : plan(spec.plan()),
        jitter(spec.jitter),
        width(spec.filter.width),
        opens(spec.startTime + frame * spec.frameLength),
        shutter(std::max(spec.shutter, 0.0)),
        key(frameKey(seed, frame)),
        columns(spec.filter, plan.side) {}

  // The pixel (x, y) is the square of the filter's width around the screen position (x, y), not around its middle: so
  // does rayshade 4.
  SamplePosition operator()(const SampleId& id) const {
    SamplePosition at;
    at.plan = plan;
    at.time = opens;
    const RandomKey pixel = pixelKey(key, static_cast<std::uint32_t>(id.x), static_cast<std::uint32_t>(id.y));
    if (plan.sampling == Sampling::nets) {
      at.key = pixel;
      at.number = id.cell;
    } else {
      at.key = child(pixel, static_cast<std::uint32_t>(id.cell));
      at.number = plan.side == 1 ? 0 : sampleNumber(plan.side, id.cell);
    }
    if (plan.sampling == Sampling::nets && jitter) {
      inNet(id, at);
    } else {
      inCell(id, at);
    }
    return at;
  }

 private:
  void inNet(const SampleId& id, SamplePosition& at) const {
    const SquarePoint place = plan.anywhere(id.cell, at.key, 0, Dimension::jitterX, Dimension::jitterY);
    at.u = id.x + (columns(place.x) - 0.5) * width;
    at.v = id.y + (columns(place.y) - 0.5) * width;
    if (shutter > 0)
      at.time += shutter * plan.anywhere(id.cell, at.key, plan.uses.time, Dimension::time, Dimension::time).x;
  }

  // Without jitter a sample sits in the upper left corner of its cell.
  void inCell(const SampleId& id, SamplePosition& at) const {
    const std::int32_t side = plan.side;
    const double cell = width / side;
    auto jittered = [&](Dimension dimension) { return jitter ? uniform(at.key, dimension) : 0.0; };
    const std::int32_t row = side == 1 ? 0 : id.cell / side, column = id.cell - row * side;
    at.u = id.x - width / 2 + (column + jittered(Dimension::jitterX)) * cell;
    at.v = id.y - width / 2 + (row + jittered(Dimension::jitterY)) * cell;
    if (shutter > 0) {
      const std::int32_t number = side == 1 ? 0 : sampleNumber(side, id.cell);
      at.time += shutter / (side * side) * (number + jittered(Dimension::time));
    }
  }
};

}  // namespace

SamplePosition samplePosition(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame,
                              const SampleId& id) {
  return SampleGrid(spec, seed, frame)(id);
}

void samplePositions(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame,
                     std::span<const SampleId> ids, std::span<SamplePosition> positions) {
  const SampleGrid grid(spec, seed, frame);
  for (std::size_t i = 0; i < ids.size(); ++i) positions[i] = grid(ids[i]);
}

// The lens is always jittered: without it there would be side^2 sharp pictures on top of each other.
LensPosition lensPosition(const SamplePosition& at) {
  const SquarePoint through =
      at.plan.inStratum(at.number, at.key, at.plan.uses.lens, Dimension::lensX, Dimension::lensY);
  return {2 * through.x - 1, 2 * through.y - 1};
}

}  // namespace rayshade
