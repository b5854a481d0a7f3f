// The sampler: its rows are those of the plain rule for any tiles and any order of supply.
//
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/sampling/sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <tuple>
#include <variant>

#include "tests/support/sampled_picture.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

TEST(Contrast, IsRelativeToTheSumOfTheExtremes) {
  const Color threshold{0.2, 0.2, 0.2};
  auto test = [&](Color a, Color b) {
    return tooMuchContrast(std::array<Color, 5>{a, a, b, a, a}, threshold);
  };
  EXPECT_FALSE(test({4, 4, 4}, {4, 4, 4}));
  EXPECT_FALSE(test({3, 0, 0}, {2, 0, 0}));     // 1 / 5
  EXPECT_TRUE(test({3.001, 0, 0}, {2, 0, 0}));  // in red
  EXPECT_TRUE(test({0, 0, 2}, {0, 0, 3.001}));  // in blue
  EXPECT_TRUE(test({1e-5, 0, 0}, {2e-6, 0, 0}));
  EXPECT_FALSE(test({9e-6, 0, 0}, {0, 0, 0}));  // too dark
  EXPECT_FALSE(test({-1, -1, -1}, {1, 1, 1}));  // no light together
}

TEST(Sampler, GivesTheRowsOfThePlainRuleForAnyOrder) {
  SeededRandom random(1);
  const Order anyOne = [&](std::size_t count) { return random.below(count); };
  for (auto [side, contrast, refinement] : {std::tuple{2, 1.0, Refinement::crosses},
                                            {3, 1.0, Refinement::neighbours},
                                            {3, 0.5, Refinement::crosses},
                                            {6, 1.0, Refinement::neighbours},
                                            {12, 1.0, Refinement::neighbours}}) {
    PictureSpec spec = specOf(37, 29, side);
    spec.refinement = refinement;
    if (side == 2) spec.sampling = Sampling::strata;
    spec.contrast = spec.contrast * contrast;
    spec.filter = {side == 3, 1.8};
    const Reference expected = reference(spec);
    ASSERT_GT(expected.refined, 50u);  // or else the test tests nothing
    ASSERT_LT(expected.refined, 900u);
    for (std::int32_t tileSide : {1, 5, 8, 32, 100})
      for (std::size_t window : {1u, 2u, 17u, 300u})
        for (const Order& order : {Order(oldest), Order(newest), anyOne})
          EXPECT_TRUE(run(spec, window, order, tileSide) == expected.rows)
              << side << " tiles " << tileSide << " window " << window;
  }
}

TEST(Sampler, GivesTheRowsOfThePlainRuleForAnySize) {
  SeededRandom random(2);
  const Order anyOne = [&](std::size_t count) { return random.below(count); };
  for (std::int32_t side : {1, 2, 8})
    for (auto [width, height] : {std::pair{1, 1},
                                 {1, 9},
                                 {9, 1},
                                 {2, 2},
                                 {2, 9},
                                 {9, 2},
                                 {3, 3},
                                 {3, 20},
                                 {20, 3},
                                 {8, 8},
                                 {9, 17}}) {
      PictureSpec spec = specOf(width, height, side);
      for (const Refinement refinement : {Refinement::crosses, Refinement::neighbours}) {
        spec.refinement = refinement;
        for (std::int32_t tileSide : {1, 4, 32})
          EXPECT_TRUE(run(spec, 50, anyOne, tileSide) == reference(spec).rows)
              << width << " x " << height << " side " << side << " tiles " << tileSide;
      }
    }
}

TEST(Sampler, AWindowHasThePixelsOfTheWholePicture) {
  SeededRandom random(3);
  const Order anyOne = [&](std::size_t count) { return random.below(count); };
  for (const Refinement refinement : {Refinement::crosses, Refinement::neighbours, Refinement::all})
    for (const std::array<std::int32_t, 4>& window : {std::array{0, 36, 0, 28},
                                                      {0, 0, 0, 0},
                                                      {36, 36, 28, 28},
                                                      {10, 20, 5, 17},
                                                      {0, 9, 27, 28},
                                                      {4, 4, 0, 28},
                                                      {7, 30, 26, 26}}) {
      PictureSpec spec = specOf(37, 29, 3);
      spec.refinement = refinement;
      Rows expected;
      if (refinement == Refinement::all) {
        spec.contrast = kBlack;
        expected = run(spec, 50, anyOne, 32);
        expected.erase(expected.begin() + window[3] + 1, expected.end());
        expected.erase(expected.begin(), expected.begin() + window[2]);
        for (std::vector<Color>& row : expected) row = {row.begin() + window[0], row.begin() + window[1] + 1};
      }
      spec.window = window;
      if (refinement != Refinement::all) expected = reference(spec).rows;
      for (std::int32_t tileSide : {1, 5, 32})
        EXPECT_TRUE(run(spec, 50, anyOne, tileSide) == expected)
            << window[0] << " " << window[2] << " tiles " << tileSide << " rule "
            << static_cast<int>(refinement);
    }
}

TEST(Sampler, WithoutAContrastThatIsAllowedAllPixelsGetAllSamples) {
  PictureSpec spec = specOf(13, 11, 3);
  spec.contrast = kBlack;
  SamplerCounts counts;
  run(spec, 1, oldest, 4, &counts);
  EXPECT_EQ(counts.given, 13u * 11u * 9u);
}

// A dot in the middle of a pixel, that fills a ninth of it: what comes of its light on the average.
TEST(Sampler, NeighboursKeepTheLightOfSmallThingsAndCrossesLoseIt) {
  const auto share = [](Refinement refinement) {
    double sum = 0;
    constexpr std::uint64_t kSeeds = 4000;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      PictureSpec spec = specOf(5, 5, 3);
      spec.refinement = refinement;
      Sampler sampler(spec, seed, 0);
      std::vector<Color> row;
      while (!sampler.finished()) {
        EXPECT_TRUE(supplyNext(sampler, [&](const SampleId& id) {
          const SamplePosition at = samplePosition(spec, seed, 0, id);
          return std::abs(at.u - 2) < 1.0 / 6 && std::abs(at.v - 2) < 1.0 / 6 ? kWhite : kBlack;
        }));
        while (sampler.takeRow(row))
          for (const Color& color : row) sum += color.r;
      }
    }
    return 9 * sum / kSeeds;
  };
  EXPECT_NEAR(share(Refinement::neighbours), 1, 0.18);  // four deviations
  EXPECT_LT(share(Refinement::crosses), 0.2);
}

TEST(Sampler, LineBelowThePictureRefinesTheLastLineButOne) {
  PictureSpec spec = specOf(5, 4, 2);
  spec.refinement = Refinement::crosses;
  auto rowsWith = [&](double below) {
    Sampler sampler(spec, kSeed, kFrame);
    supplyNext(sampler, [&](const SampleId& id) {
      const double light = id.y == 4 ? below : id.y == 2 ? 1 + 0.1 * id.cell : 1.1;
      return Color{light, light, light};
    });
    Rows rows;
    std::vector<Color> row;
    while (sampler.takeRow(row)) rows.push_back(row);
    EXPECT_TRUE(sampler.finished());
    return rows;
  };
  const double mean = 1 + 0.1 * 1.5;  // of the four cells
  EXPECT_DOUBLE_EQ(rowsWith(5)[2][2].r, mean);
  EXPECT_NE(rowsWith(1.1)[2][2].r, rowsWith(5)[2][2].r);
}

TEST(Sampler, CountsWhatTheRuleAskedForWhateverRanAhead) {
  PictureSpec spec = specOf(37, 29, 3);
  spec.refinement = Refinement::crosses;
  const std::uint64_t refined = reference(spec).refined, border = 2 * 37 + 2 * 27, inside = 35 * 27;
  const std::uint64_t samples = 9 * border + inside + 35 + 8 * refined;  // 35: the line below
  SamplerCounts counts;
  run(spec, 1, oldest, 100, &counts);  // one tile sees all that the picture's sweep sees
  EXPECT_EQ(counts.needed, samples);
  EXPECT_EQ(counts.given, samples);
  EXPECT_EQ(counts.supersampled, border + refined);
  run(spec, 300, newest, 1, &counts);  // no tile refines anything
  EXPECT_EQ(counts.given, samples);
  run(spec, 300, newest, 8, &counts);
  EXPECT_EQ(counts.needed, samples);
  EXPECT_GE(counts.given, samples);
  EXPECT_LT(counts.given, samples + samples / 100);
}

TEST(Sampler, GivesEachSampleOnce) {
  const PictureSpec spec = specOf(20, 20, 3);
  for (std::int32_t tileSide : {1, 7, 32}) {
    Sampler sampler(spec, kSeed, kFrame, tileSide);
    std::vector<std::uint8_t> seen(20 * 21 * 9);
    const auto see = [&](const SampleId& id) {
      EXPECT_EQ(seen[static_cast<std::size_t>((id.y * 20 + id.x) * 9 + id.cell)]++, 0);
      return colorOf(spec, id);
    };
    std::vector<Color> row;
    while (!sampler.finished()) {
      ASSERT_TRUE(supplyNext(sampler, see));
      while (sampler.takeRow(row)) continue;
    }
    EXPECT_FALSE(supplyNext(sampler, see));
    EXPECT_FALSE(sampler.takeRow(row));
  }
}

TEST(Sampler, IgnoresColoursThatDoNotBelongToIt) {
  const PictureSpec spec = specOf(12, 12, 2);
  Sampler sampler(spec, kSeed, kFrame, 4);
  const Color wrong{1e9, 1e9, 1e9};
  std::vector<Color> row;
  Rows rows;
  while (!sampler.finished()) {
    for (const SampleId& other : {SampleId{-1, 0, 0},
                                  {0, -1, 0},
                                  {12, 0, 0},
                                  {0, 13, 0},
                                  {0, 0, 4},
                                  {0, 0, -1},
                                  {2147483647, -2147483647 - 1, 2147483647}})
      sampler.supply(other, wrong);
    SampleId last;
    ASSERT_TRUE(supplyNext(sampler, [&](const SampleId& id) { return colorOf(spec, last = id); }));
    sampler.supply(last, wrong);  // once more
    while (sampler.takeRow(row)) rows.push_back(row);
  }
  EXPECT_TRUE(rows == reference(spec).rows);
}

TEST(Sampler, RefusesColoursThatDoNotFitTheirTile) {
  const Tile tile{0, 0, 4, 2};
  const std::vector<Color> eight(8), seven(7), two(2);
  EXPECT_TRUE(fit({eight, {1, 7}, two, 8, 0}, tile));
  for (const TileColors& bad : {TileColors{seven, {}, {}, 7, 0},
                                {eight, {1}, two, 8, 0},
                                {eight, {1, 8}, two, 8, 0},
                                {eight, {7, 1}, two, 8, 0},
                                {eight, {1, 1}, two, 8, 0}})
    EXPECT_FALSE(fit(bad, tile));
}

TEST(Sampler, HoldsBackRowsUntilFinishedOnesAreTaken) {
  PictureSpec spec = specOf(1000, 60000, 1);
  Sampler sampler(spec, kSeed, kFrame);
  std::size_t given = 0;
  while (supplyNext(sampler, [&](const SampleId&) {
    ++given;
    return kWhite;
  }))
    ASSERT_LT(given, 300000u);
  EXPECT_GE(given, 64000u);
  std::vector<Color> row;
  ASSERT_TRUE(sampler.takeRow(row));
  EXPECT_TRUE(row == std::vector<Color>(1000, kWhite));
  while (sampler.takeRow(row)) continue;
  EXPECT_TRUE(sampler.nextTile());
}

TEST(TileSampler, GivesNeighboursTogether) {
  TileSampler sampler(samplingRules(specOf(512, 512, 1), kSeed, kFrame), {0, 0, 64, 64});
  std::vector<SampleId> block(64);
  for (int i = 0; i < 64; ++i) {
    ASSERT_EQ(sampler.next(block), 64u);
    const auto [left, right] = std::ranges::minmax(block, {}, &SampleId::x);
    const auto [top, bottom] = std::ranges::minmax(block, {}, &SampleId::y);
    EXPECT_EQ(right.x - left.x, 7);
    EXPECT_EQ(bottom.y - top.y, 7);
  }
}

TEST(Sampler, EvenLightStaysEven) {
  for (std::int32_t side = 1; side <= 8; ++side) {
    PictureSpec spec = specOf(5, 5, side);
    spec.filter = {side % 2 == 0, 1.8};
    Sampler sampler(spec, kSeed, kFrame);
    supplyNext(sampler, [](const SampleId&) { return kWhite; });
    std::vector<Color> row;
    while (sampler.takeRow(row))
      for (const Color& c : row) EXPECT_EQ(static_cast<float>(c.r), 1.0f);
    EXPECT_TRUE(sampler.finished());
  }
}

TEST(Sampler, RefusesImpossiblePictures) {
  EXPECT_THROW(Sampler(specOf(0, 5, 3), 0, 0), std::invalid_argument);
  EXPECT_THROW(Sampler(specOf(5, 5, 0), 0, 0), std::invalid_argument);
  EXPECT_THROW(Sampler(specOf(5, 5, 65), 0, 0), std::invalid_argument);
}

}  // namespace
}  // namespace rayshade
