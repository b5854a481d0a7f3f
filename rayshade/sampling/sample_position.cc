// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/sampling/sample_position.h"

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

std::int32_t sampleNumber(std::int32_t side, std::int32_t cell) {
  return kNumbers[side - 1][static_cast<std::size_t>(cell)];
}

namespace {

// What the samples of a frame have in common.
struct SampleGrid {
  std::int32_t side;
  bool jitter;
  double width, cell;  // of the filter, of a cell of a pixel                                        [pixels]
  double opens, stratum;  // of a sample in time; 0: all are taken when the shutter opens         [scene time]
  RandomKey key;

  SampleGrid(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame)
      : side(spec.samplesPerSide),
        jitter(spec.jitter),
        width(spec.filter.width),
        cell(width / side),
        opens(spec.startTime + frame * spec.frameLength),
        stratum(spec.shutter > 0 ? spec.shutter / (side * side) : 0),
        key(frameKey(seed, frame)) {}

  // The pixel (x, y) is the square of the filter's width around the screen position (x, y), not around its middle: so
  // does rayshade 4.  Without jitter a sample sits in the upper left corner of its cell.
  SamplePosition operator()(const SampleId& id) const {
    SamplePosition at;
    at.key = sampleKey(key, static_cast<std::uint32_t>(id.x), static_cast<std::uint32_t>(id.y),
                       static_cast<std::uint32_t>(id.cell));
    at.side = side;
    at.number = side == 1 ? 0 : sampleNumber(side, id.cell);
    auto jittered = [&](Dimension dimension) { return jitter ? uniform(at.key, dimension) : 0.0; };
    const std::int32_t row = side == 1 ? 0 : id.cell / side, column = id.cell - row * side;
    at.u = id.x - width / 2 + (column + jittered(Dimension::jitterX)) * cell;
    at.v = id.y - width / 2 + (row + jittered(Dimension::jitterY)) * cell;
    at.time = opens;
    if (stratum > 0) at.time += stratum * (at.number + jittered(Dimension::time));
    return at;
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
  return {2 * (at.number % at.side + uniform(at.key, Dimension::lensX)) / at.side - 1,
          2 * (at.number / at.side + uniform(at.key, Dimension::lensY)) / at.side - 1};
}

}  // namespace rayshade
