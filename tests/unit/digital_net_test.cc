// Nets: how evenly their points lie, and that each alone is uniform.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/digital_net.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace rayshade {
namespace {

RandomKey keyOf(std::uint64_t trial) { return RandomKey{mixBits(trial)}; }

// How many boxes of a grid hold exactly one point.
std::size_t boxesWithOne(const std::vector<std::uint32_t>& boxOfPoint) {
  std::vector<int> count(boxOfPoint.size());
  for (const std::uint32_t box : boxOfPoint) ++count.at(box);
  return static_cast<std::size_t>(std::count(count.begin(), count.end(), 1));
}

std::uint32_t part(double x, std::int32_t parts) { return static_cast<std::uint32_t>(x * parts); }

TEST(DigitalNet, EachCoordinateHasOnePointInEachInterval) {
  for (const std::int32_t side : {1, 2, 3, 4, 5, 7, 8, 9, 16, 25, 27, 32, 49, 64}) {
    const DigitalNet& net = DigitalNet::of(side);
    ASSERT_EQ(net.size(), static_cast<std::uint32_t>(side * side));
    for (std::uint32_t c = 0; c < net.coordinates() + 3; ++c) {
      std::vector<std::uint32_t> boxes;
      for (std::uint32_t i = 0; i < net.size(); ++i)
        boxes.push_back(part(net.coordinate(i, c, keyOf(c)), side * side));
      EXPECT_EQ(boxesWithOne(boxes), net.size()) << side << " coordinate " << c;
    }
  }
}

// The pairs that are used: the place in the pixel with any other, and what lies beyond the coordinates.
TEST(DigitalNet, PairsHaveOnePointInEachSquare) {
  for (const std::int32_t side : {2, 3, 4, 5, 7, 8, 9, 16, 25, 27, 32, 49, 64})
    for (const std::uint32_t c : {0u, 1u, 100u}) {
      const DigitalNet& net = DigitalNet::of(side);
      std::vector<std::uint32_t> boxes;
      for (std::uint32_t i = 0; i < net.size(); ++i) {
        const SquarePoint at = net.square(i, c, keyOf(1));
        boxes.push_back(part(at.x, side) + static_cast<std::uint32_t>(side) * part(at.y, side));
      }
      EXPECT_EQ(boxesWithOne(boxes), net.size()) << side << " from coordinate " << c;
    }
}

TEST(DigitalNet, OfThreeFiveAndSevenAnyTwoCoordinatesKnowOfEachOther) {
  for (const std::int32_t side : {3, 5, 7}) {
    const DigitalNet& net = DigitalNet::of(side);
    ASSERT_EQ(net.coordinates(), static_cast<std::uint32_t>(side) + 1);
    for (std::uint32_t a = 0; a < net.coordinates(); ++a)
      for (std::uint32_t b = 0; b < a; ++b) {
        std::vector<std::uint32_t> boxes;
        for (std::uint32_t i = 0; i < net.size(); ++i)
          boxes.push_back(part(net.coordinate(i, a, keyOf(a)), side) +
                          static_cast<std::uint32_t>(side) * part(net.coordinate(i, b, keyOf(90 + b)), side));
        EXPECT_EQ(boxesWithOne(boxes), net.size()) << side << " coordinates " << a << " " << b;
      }
  }
}

TEST(DigitalNet, EachPointAloneIsUniformWhateverItsNumber) {
  constexpr int kTrials = 40000, kParts = 12;
  for (const std::int32_t side : {1, 2, 3, 5, 6, 8})
    for (const std::uint32_t number : {0u, static_cast<std::uint32_t>(side * side) - 1})
      for (const std::uint32_t c : {0u, 2u, 50u}) {
        std::vector<double> x(kParts), xy(kParts);
        for (int trial = 0; trial < kTrials; ++trial) {
          const SquarePoint at =
              DigitalNet::of(side).square(number, c, keyOf(static_cast<std::uint64_t>(trial)));
          ASSERT_TRUE(at.x >= 0 && at.x < 1 && at.y >= 0 && at.y < 1);
          ++x[part(at.x, kParts)];
          ++xy[part(at.x, 3) + 3 * part(at.y, 4)];
        }
        double far = 0;
        for (int i = 0; i < kParts; ++i)
          for (const double n : {x[static_cast<std::size_t>(i)], xy[static_cast<std::size_t>(i)]})
            far = std::max(far, std::abs(n - kTrials / kParts));
        EXPECT_LT(far, 5 * std::sqrt(kTrials / kParts)) << side << " point " << number << " coordinate " << c;
      }
}

TEST(DigitalNet, AnyNumberHasAPoint) {  // numbers come in messages
  for (const std::int32_t side : {1, 3, 6, 64})
    for (const std::uint32_t number : {4096u, 0x80000000u, 0xffffffffu}) {
      const SquarePoint at = DigitalNet::of(side).square(number, 2, RandomKey{5});
      EXPECT_TRUE(at.x >= 0 && at.x < 1 && at.y >= 0 && at.y < 1) << side << " " << number;
    }
}

// The share of a half space in the cube of four coordinates: of as many independent points it has the variance p (1 - p) / N.
TEST(DigitalNet, MeansVaryMuchLessThanThoseOfIndependentPoints) {
  for (const auto& [side, ratio] : {std::pair{3, 3.0}, {4, 4.0}, {6, 4.0}, {8, 8.0}, {16, 12.0}}) {
    const DigitalNet& net = DigitalNet::of(side);
    constexpr int kTrials = 400;
    double sum = 0, squares = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      double inside = 0;
      for (std::uint32_t i = 0; i < net.size(); ++i) {
        const SquarePoint pixel = net.square(i, 0, keyOf(static_cast<std::uint64_t>(2 * trial)));
        const SquarePoint light = net.square(i, 2, keyOf(static_cast<std::uint64_t>(2 * trial + 1)));
        inside += 0.2 * pixel.x + 0.1 * pixel.y + light.x + 0.4 * light.y < 0.85;
      }
      sum += inside / net.size();
      squares += inside * inside / net.size() / net.size();
    }
    const double mean = sum / kTrials, variance = squares / kTrials - mean * mean;
    EXPECT_NEAR(mean, 0.5, 0.01) << side;
    EXPECT_GT(mean * (1 - mean) / net.size() / variance, ratio) << side;
  }
}

}  // namespace
}  // namespace rayshade
