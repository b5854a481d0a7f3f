// The sampler: its rows are those of the plain rule for any tiles and any order of supply.
//
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/sampling/sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <variant>

#include "rayshade/sampling/filter.h"
#include "tests/support/seeded_random.h"
#include "tests/support/traced_tile.h"

namespace rayshade {
namespace {

using Rows = std::vector<std::vector<Color>>;
constexpr std::uint64_t kSeed = 7;
constexpr std::uint32_t kFrame = 3;

// A scene: edges, a fine pattern that refines again and again, smooth parts, black, light above 1.
Color colorOf(const PictureSpec& spec, const SampleId& id) {
  const SamplePosition at = samplePosition(spec, kSeed, kFrame, id);
  if (std::hypot(at.u - 7, at.v - 9) < 5.3) return {2 + at.u / 50, 0.4, 0.1};
  if (at.u + 0.3 * at.v > 24) return {0.5 + 0.5 * std::sin(at.u * at.v), 0.5, 0.5};
  if (at.v > 20) return {0, 0, 1e-6 * at.u};
  return {0.2 + at.u / 200, 0.3, 0.4 + at.v / 300};
}

// The rule as it stands in rayshade, with all of the picture and of the line below it in memory.
struct Reference {
  Rows rows;
  std::uint64_t refined = 0;
};
Reference reference(const PictureSpec& spec) {
  const PixelArea area = *pixelArea(spec);
  const int side = spec.samplesPerSide, cells = side * side;
  const auto weights = filterWeights(spec.filter, side);
  struct Pixel {
    Color color;
    int cell = 0;
    bool full = false;
  };
  std::vector<std::vector<Pixel>> lines(static_cast<std::size_t>(area.height) + 1,
                                        std::vector<Pixel>(static_cast<std::size_t>(area.width)));
  auto at = [&](int x, int y) -> Pixel& {
    return lines[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
  };
  auto trace = [&](int x, int y, int cell) { return colorOf(spec, {area.x + x, area.y + y, cell}); };
  auto fill = [&](int x, int y) {
    Pixel& pixel = at(x, y);
    const std::size_t first = static_cast<std::size_t>(pixel.cell);
    pixel.color = trace(x, y, pixel.cell) * weights[first];
    for (std::size_t cell = 0; cell < weights.size(); ++cell)
      if (cell != first) pixel.color = pixel.color + trace(x, y, static_cast<int>(cell)) * weights[cell];
    pixel.full = true;
  };

  Reference result;
  for (int y = 0; y <= area.height; ++y)
    for (int x = 0; x < area.width; ++x) {
      if (y == 0 || y == area.height - 1 || x == 0 || x == area.width - 1) {
        fill(x, y);
        continue;
      }
      const RandomKey key = sampleKey(kSeed, kFrame, static_cast<std::uint32_t>(area.x + x),
                                      static_cast<std::uint32_t>(area.y + y), 0xffffffffu);
      at(x, y).cell = static_cast<int>(uniform(key, Dimension::firstCell) * cells);
      at(x, y).color = trace(x, y, at(x, y).cell);
    }
  for (int y = 1; cells > 1 && y < area.height; ++y) {
    for (bool changed = true; changed;) {
      changed = false;
      for (int x = 1; x + 1 < area.width; ++x) {
        const int cross[5][2] = {{x, y - 1}, {x - 1, y}, {x, y}, {x + 1, y}, {x, y + 1}};
        std::array<Color, 5> colors;
        for (std::size_t i = 0; i < 5; ++i) colors[i] = at(cross[i][0], cross[i][1]).color;
        if (!tooMuchContrast(colors, spec.contrast)) continue;
        for (const auto& [cx, cy] : cross) {
          if (at(cx, cy).full) continue;
          fill(cx, cy);
          changed = true;
          if (cy < area.height) ++result.refined;
        }
      }
    }
  }
  for (int y = 0; y < area.height; ++y) {
    result.rows.emplace_back();
    for (int x = 0; x < area.width; ++x) result.rows.back().push_back(at(x, y).color);
  }
  return result;
}

// Chooses which of `count` things on the way comes next.
using Order = std::function<std::size_t(std::size_t count)>;

template <class T>
T takeOne(std::vector<T>& flying, const Order& order) {
  const auto chosen = flying.begin() + static_cast<std::ptrdiff_t>(order(flying.size()));
  T one = std::move(*chosen);
  flying.erase(chosen);
  return one;
}

// What a tile's samples become, in whatever order their colours come.
TileColors traceTile(const PictureSpec& spec, const Tile& tile, std::size_t window, const Order& order) {
  TileSampler sampler(samplingRules(spec, kSeed, kFrame), tile);
  std::vector<SampleId> flying, batch(window);
  while (!sampler.finished()) {
    const std::size_t n = sampler.next(std::span(batch).first(window - flying.size()));
    flying.insert(flying.end(), batch.begin(), batch.begin() + static_cast<std::ptrdiff_t>(n));
    if (flying.empty()) {
      ADD_FAILURE() << "stuck in the tile at " << tile.x << " " << tile.y;
      break;
    }
    const SampleId id = takeOne(flying, order);
    sampler.supply(id, colorOf(spec, id));
  }
  return sampler.colors();
}

Rows run(const PictureSpec& spec, std::size_t window, const Order& order, std::int32_t tileSide,
         SamplerCounts* counts = nullptr) {
  Sampler sampler(spec, kSeed, kFrame, tileSide);
  std::vector<std::variant<Tile, SampleId>> flying;
  std::vector<Color> row;
  Rows rows;
  while (!sampler.finished()) {
    while (flying.size() < window) {
      SampleId id;
      if (sampler.nextSamples(std::span(&id, 1)) == 1) {
        flying.push_back(id);
      } else if (const auto tile = sampler.nextTile()) {
        flying.push_back(*tile);
      } else {
        break;
      }
    }
    if (flying.empty()) {
      ADD_FAILURE() << "stuck at row " << rows.size();
      break;
    }
    const auto next = takeOne(flying, order);
    if (const Tile* tile = std::get_if<Tile>(&next)) {
      const TileColors colors = traceTile(spec, *tile, window, order);
      EXPECT_TRUE(fit(colors, *tile));
      sampler.supply(*tile, colors);
    } else {
      sampler.supply(std::get<SampleId>(next), colorOf(spec, std::get<SampleId>(next)));
    }
    while (sampler.takeRow(row)) rows.push_back(row);
  }
  if (counts) *counts = sampler.counts();
  return rows;
}

std::size_t oldest(std::size_t) { return 0; }
std::size_t newest(std::size_t count) { return count - 1; }

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
  for (auto [side, contrast] : {std::pair{2, 1.0}, {3, 1.0}, {3, 0.5}, {6, 1.0}}) {
    PictureSpec spec = specOf(37, 29, side);
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
      PictureSpec spec = specOf(40, 40, side);
      spec.window = {4, 4 + width - 1, 6, 6 + height - 1};
      for (std::int32_t tileSide : {1, 4, 32})
        EXPECT_TRUE(run(spec, 50, anyOne, tileSide) == reference(spec).rows)
            << width << " x " << height << " side " << side << " tiles " << tileSide;
    }
}

TEST(Sampler, LineBelowThePictureRefinesTheLastLineButOne) {
  PictureSpec spec = specOf(5, 4, 2);
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
  const PictureSpec spec = specOf(37, 29, 3);
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
  EXPECT_THROW(Sampler(specOf(5, 5, 9), 0, 0), std::invalid_argument);
}

}  // namespace
}  // namespace rayshade
