// Random numbers without a stream: pure, uniform, and no two uses share one.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/random.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>
#include <vector>

namespace rayshade {
namespace {

constexpr std::uint32_t kDimensions = static_cast<std::uint32_t>(Dimension::glossY) + 1;

// The first numbers of the published SplitMix64 generator with seed 0: its state goes up by 0x9e37....
TEST(Random, TheMixingFunctionIsThatOfSplitMix64) {
  EXPECT_EQ(mixBits(0), 0xe220a8397b1dcdafu);
  EXPECT_EQ(mixBits(0x9e3779b97f4a7c15u), 0x6e789e6aa1b965f4u);
  EXPECT_EQ(mixBits(2 * 0x9e3779b97f4a7c15u), 0x06c45d188009454fu);
}

TEST(Random, EveryBitOfTheInputChangesHalfOfTheOutput) {
  for (int bit = 0; bit < 64; ++bit) {
    int changed = 0;
    for (std::uint64_t x = 0; x < 256; ++x)
      changed += std::popcount(mixBits(x) ^ mixBits(x ^ std::uint64_t{1} << bit));
    EXPECT_NEAR(changed / 256.0, 32, 2) << "bit " << bit;
  }
}

TEST(Random, NumbersLieInTheUnitIntervalAndAreMultiplesOfItsStep) {
  for (std::uint32_t i = 0; i < 100000; ++i) {
    const double u = uniform(RandomKey{i}, Dimension::lightU, i % 7);
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    ASSERT_EQ(u * 0x1p+53, std::floor(u * 0x1p+53));
  }
}

TEST(Random, ItIsAFunctionOfItsArguments) {
  static_assert(uniform(sampleKey(1, 2, 3, 4, 5), Dimension::lensX) ==
                uniform(sampleKey(1, 2, 3, 4, 5), Dimension::lensX));
  // Pictures depend on these numbers: they do not change from version to version.
  EXPECT_EQ(static_cast<std::uint64_t>(sampleKey(0, 1, 2, 3, 4)), 0xd6d97d3afd08b024u);
}

TEST(Random, NoTwoUsesShareANumber) {
  std::set<double> seen;
  std::size_t count = 0;
  auto use = [&](RandomKey key) {
    for (std::uint32_t dimension = 0; dimension < kDimensions; ++dimension)
      for (std::uint32_t index = 0; index < 8; ++index, ++count)
        seen.insert(uniform(key, Dimension{dimension}, index));
  };
  for (std::uint32_t cell = 0; cell < 4; ++cell)
    for (std::uint32_t x = 0; x < 4; ++x)
      for (std::uint32_t y = 0; y < 4; ++y) {
        const RandomKey key = sampleKey(7, 0, x, y, cell);
        use(key);
        use(child(key, Branch::reflected));
        use(child(key, Branch::transmitted));
        for (std::uint32_t light = 0; light < 3; ++light) use(child(key, Branch::light, light));
      }
  EXPECT_EQ(seen.size(), count);
}

TEST(Random, SeedFramePixelAndCellAllMatter) {
  std::set<RandomKey> keys;
  for (std::uint32_t large : {0u, 1u, 65535u, 0xffffffffu}) {
    keys.insert(sampleKey(large, 9, 9, 9, 9));
    keys.insert(sampleKey(9, large, 9, 9, 9));
    keys.insert(sampleKey(9, 9, large, 9, 9));
    keys.insert(sampleKey(9, 9, 9, large, 9));
    keys.insert(sampleKey(9, 9, 9, 9, large));
  }
  EXPECT_EQ(keys.size(), 20u);
  EXPECT_NE(sampleKey(std::uint64_t{1} << 32, 9, 9, 9, 9), sampleKey(0, 9, 9, 9, 9));
  EXPECT_NE(sampleKey(1, 1, 5, 5, 0), sampleKey(2, 2, 5, 5, 0)) << "seeds that go with the frames";
  EXPECT_NE(sampleKey(0, 0, 1, 2, 0), sampleKey(0, 0, 2, 1, 0)) << "x and y are not the same";
}

TEST(Random, APathIsToldByItsOrder) {
  const RandomKey eye = sampleKey(0, 0, 1, 1, 0);
  EXPECT_NE(child(child(eye, Branch::reflected), Branch::transmitted),
            child(child(eye, Branch::transmitted), Branch::reflected));
  EXPECT_NE(child(eye, Branch::reflected), eye);
}

// Neighbouring pixels are what is compared in a picture: pairs of them fill the unit square evenly.
TEST(Random, NeighboursFillTheSquareEvenly) {
  constexpr int kSide = 8, kPairs = 64000;
  std::vector<int> boxes(kSide * kSide);
  for (std::uint32_t i = 0; i < kPairs; ++i) {
    const double a = uniform(sampleKey(0, 0, i % 320, i / 320, 0), Dimension::jitterX);
    const double b = uniform(sampleKey(0, 0, i % 320 + 1, i / 320, 0), Dimension::jitterX);
    ++boxes[static_cast<std::size_t>(static_cast<int>(a * kSide) * kSide + static_cast<int>(b * kSide))];
  }
  double chiSquare = 0;
  const double expected = static_cast<double>(kPairs) / (kSide * kSide);
  for (int n : boxes) chiSquare += (n - expected) * (n - expected) / expected;
  EXPECT_LT(chiSquare, 120) << "63 degrees of freedom: one in 20000 would be more by chance";
}

}  // namespace
}  // namespace rayshade
