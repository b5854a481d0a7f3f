// Where samples are taken: positions and strata.
//
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/sampling/sample_position.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include "rayshade/sampling/filter.h"
#include "tests/support/traced_tile.h"

namespace rayshade {
namespace {

constexpr std::uint64_t kSeed = 7;

PictureSpec strataOf(std::int32_t width, std::int32_t height, std::int32_t side) {
  PictureSpec spec = specOf(width, height, side);
  spec.sampling = Sampling::strata;
  return spec;
}

TEST(SampleNumbers, AreAPermutationOfTheStrata) {
  for (std::int32_t side = 1; side <= kMaxSamplesPerSide; ++side) {
    std::vector<std::int32_t> numbers, expected(static_cast<std::size_t>(side * side));
    for (std::int32_t cell = 0; cell < side * side; ++cell) numbers.push_back(sampleNumber(side, cell));
    std::sort(numbers.begin(), numbers.end());
    std::iota(expected.begin(), expected.end(), side >= 6 && side <= 8 ? 1 : 0);
    EXPECT_EQ(numbers, expected) << side;
  }
}

TEST(SampleNumbers, OfTheLargeSidesFormMagicSquares) {
  for (std::int32_t side : {6, 7, 8}) {
    const std::int32_t magic = side * (side * side + 1) / 2;
    for (std::int32_t i = 0; i < side; ++i) {
      std::int32_t row = 0, column = 0;
      for (std::int32_t j = 0; j < side; ++j) {
        row += sampleNumber(side, j + i * side);
        column += sampleNumber(side, i + j * side);
      }
      EXPECT_EQ(row, magic) << side << " row " << i;
      EXPECT_EQ(column, magic) << side << " column " << i;
    }
  }
}

TEST(SamplePosition, WithoutJitterIsTheUpperLeftCornerOfTheCell) {
  PictureSpec spec = specOf(64, 64, 4);
  spec.jitter = false;
  spec.filter.width = 2;
  const SamplePosition at = samplePosition(spec, kSeed, 0, {10, 20, 6});  // column 2, row 1
  EXPECT_EQ(at.u, 10.0);
  EXPECT_EQ(at.v, 19.5);
  EXPECT_EQ(at.number, 6);
  spec.sampling = Sampling::strata;
  EXPECT_EQ(samplePosition(spec, kSeed, 0, {10, 20, 6}).number, 14);
  EXPECT_EQ(samplePosition(spec, kSeed, 0, {10, 20, 6}).v, 19.5);
}

TEST(SamplePosition, WithJitterFillsTheCell) {
  const PictureSpec spec = strataOf(64, 64, 2);
  double low = 1, high = 0, mean = 0;
  for (std::int32_t x = 0; x < 1000; ++x) {
    const SamplePosition at = samplePosition(spec, kSeed, 0, {x, 5, 1});
    const double inCell = at.u - x;  // 0 .. 0.5
    low = std::min(low, inCell);
    high = std::max(high, inCell);
    mean += inCell / 1000;
    EXPECT_GE(at.v, 4.5);
    EXPECT_LT(at.v, 5.0);
  }
  EXPECT_GE(low, 0);
  EXPECT_LT(low, 0.01);
  EXPECT_LT(high, 0.5);
  EXPECT_GT(high, 0.49);
  EXPECT_NEAR(mean, 0.25, 0.02);
}

TEST(SamplePosition, TimeGoesByFrameAndStratum) {
  PictureSpec spec = strataOf(64, 64, 2);
  spec.startTime = 10;
  spec.frameLength = 2;
  EXPECT_EQ(samplePosition(spec, kSeed, 3, {0, 0, 2}).time, 16);  // no shutter: the start of the frame
  spec.shutter = 1;
  const double time = samplePosition(spec, kSeed, 3, {0, 0, 2}).time;  // cell 2 has number 3
  EXPECT_GE(time, 16.75);
  EXPECT_LT(time, 17);
  spec.jitter = false;
  EXPECT_EQ(samplePosition(spec, kSeed, 3, {0, 0, 2}).time, 16.75);
}

TEST(SamplePosition, LensPointLiesInTheStratumOfTheNumber) {
  const PictureSpec spec = strataOf(64, 64, 3);
  for (std::int32_t cell = 0; cell < 9; ++cell) {
    const SamplePosition at = samplePosition(spec, kSeed, 0, {1, 2, cell});
    const LensPosition lens = lensPosition(at);
    EXPECT_EQ(std::floor((lens.x + 1) * 1.5), at.number % 3);
    EXPECT_EQ(std::floor((lens.y + 1) * 1.5), at.number / 3);
  }
}

TEST(SamplePosition, DiffersBySeedFramePixelAndCell) {
  const PictureSpec spec = strataOf(64, 64, 3);
  const auto key = samplePosition(spec, 1, 1, {1, 2, 0}).key;
  EXPECT_EQ(samplePosition(spec, 1, 1, {1, 2, 0}).key, key);
  EXPECT_NE(samplePosition(spec, 2, 1, {1, 2, 0}).key, key);
  EXPECT_NE(samplePosition(spec, 1, 2, {1, 2, 0}).key, key);
  EXPECT_NE(samplePosition(spec, 1, 1, {2, 1, 0}).key, key);
  EXPECT_NE(samplePosition(spec, 1, 1, {1, 2, 1}).key, key);
}

TEST(SamplePosition, TheSamplesOfANetHaveOneKeyAndAPointEach) {
  const PictureSpec spec = specOf(64, 64, 3);
  const SamplePosition one = samplePosition(spec, 1, 1, {1, 2, 0}),
                       other = samplePosition(spec, 1, 1, {1, 2, 5});
  EXPECT_EQ(one.key, other.key);
  EXPECT_EQ(other.number, 5);
  EXPECT_NE(one.u, other.u);
  EXPECT_NE(one.key, samplePosition(spec, 2, 1, {1, 2, 0}).key);
  EXPECT_NE(one.key, samplePosition(spec, 1, 2, {1, 2, 0}).key);
  EXPECT_NE(one.key, samplePosition(spec, 1, 1, {2, 1, 0}).key);
}

// Place in the pixel, lens and moment: as many different cells, columns and moments as there are samples.
TEST(SamplePosition, ANetFillsPixelLensAndShutter) {
  for (const std::int32_t side : {2, 3, 4, 5, 7, 8, 16}) {
    PictureSpec spec = specOf(64, 64, side);
    spec.shutter = 2;
    spec.uses = sampleUses(true, false, true);
    std::set<int> cells, throughLens, moments;
    for (std::int32_t i = 0; i < side * side; ++i) {
      const SamplePosition at = samplePosition(spec, kSeed, 0, {10, 20, i});
      const LensPosition lens = lensPosition(at);
      const auto in = [side](double x, double y) {
        return static_cast<int>(std::floor(x * side)) + 1000 * static_cast<int>(std::floor(y * side));
      };
      cells.insert(in(at.u - 9.5, at.v - 19.5));
      throughLens.insert(in((lens.x + 1) / 2, (lens.y + 1) / 2));
      moments.insert(static_cast<int>(at.time / 2 * side * side));
    }
    EXPECT_EQ(std::ssize(cells), side * side) << side;
    EXPECT_EQ(std::ssize(moments), side * side) << side;
    if (side % 2 != 0) {
      EXPECT_EQ(std::ssize(throughLens), side * side) << side;
    }
  }
}

// Samples that weigh the same are as dense as the filter is high: so their mean is that of samples that it weighs.
TEST(SamplePosition, OfANetIsAsDenseAsTheFilterIsHigh) {
  PictureSpec spec = specOf(64, 64, 3);
  spec.filter = {true, 1.8};
  const std::vector<double> weights = filterWeights(spec.filter, 3);
  std::vector<double> share(9);
  constexpr std::int32_t kPixels = 20000;
  for (std::int32_t x = 0; x < kPixels; ++x) {
    const SamplePosition at = samplePosition(spec, kSeed, 0, {x, 5, x % 9});
    const auto column = static_cast<std::size_t>((at.u - x + 0.9) / 0.6),
               row = static_cast<std::size_t>((at.v - 4.1) / 0.6);
    share.at(column + 3 * row) += 1.0 / kPixels;
  }
  for (std::size_t cell = 0; cell < 9; ++cell) EXPECT_NEAR(share[cell], weights[cell], 0.01) << cell;
}

}  // namespace
}  // namespace rayshade
