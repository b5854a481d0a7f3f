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

// The rules as they stand, with all of the screen and of the line below it in memory; then the window is cut out.
struct Reference {
  Rows rows;
  std::uint64_t refined = 0;  // of all that is sampled
};
class WholeScreen {
 public:
  explicit WholeScreen(const PictureSpec& spec)
      : spec_(spec),
        side_(spec.samplesPerSide),
        weights_(filterWeights(spec.jitter && spec.sampling == Sampling::nets ? PixelFilter{} : spec.filter,
                               side_)),
        lines_(static_cast<std::size_t>(spec.height) + 1,
               std::vector<Pixel>(static_cast<std::size_t>(spec.width))) {}

  Reference refined() {
    Reference result;
    if (spec_.refinement == Refinement::neighbours && side_ > 1) {
      result.refined = byNeighbours();
    } else {
      result.refined = byCrosses();
    }
    const PixelArea area = *pixelArea(spec_);
    for (int y = area.y; y < area.y + area.height; ++y) {
      result.rows.emplace_back();
      for (int x = area.x; x < area.x + area.width; ++x) result.rows.back().push_back(at(x, y).color);
    }
    return result;
  }

 private:
  struct Pixel {
    Color color;
    int cell = 0;
    bool full = false;
  };

  Pixel& at(int x, int y) { return lines_[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)]; }
  Color trace(int x, int y, int cell) const { return colorOf(spec_, {x, y, cell}); }
  void begin(int x, int y) {
    const RandomKey key =
        sampleKey(kSeed, kFrame, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0xffffffffu);
    at(x, y).cell = static_cast<int>(uniform(key, Dimension::firstCell) * side_ * side_);
    at(x, y).color = trace(x, y, at(x, y).cell);
  }
  void fill(int x, int y) {
    Pixel& pixel = at(x, y);
    const std::size_t first = static_cast<std::size_t>(pixel.cell);
    pixel.color = trace(x, y, pixel.cell) * weights_[first];
    for (std::size_t cell = 0; cell < weights_.size(); ++cell)
      if (cell != first) pixel.color = pixel.color + trace(x, y, static_cast<int>(cell)) * weights_[cell];
    pixel.full = true;
  }

  std::uint64_t byNeighbours() {
    for (int y = 0; y < spec_.height; ++y)
      for (int x = 0; x < spec_.width; ++x) begin(x, y);
    const auto firsts = lines_;
    std::uint64_t refined = 0;
    for (int y = 0; y < spec_.height; ++y)
      for (int x = 0; x < spec_.width; ++x) {
        std::vector<Color> around;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, spec_.height - 1); ++v)
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, spec_.width - 1); ++u)
            if (u != x || v != y)
              around.push_back(firsts[static_cast<std::size_t>(v)][static_cast<std::size_t>(u)].color);
        if (around.empty() || !tooMuchContrast(around, spec_.contrast)) continue;
        fill(x, y);
        ++refined;
      }
    return refined;
  }

  std::uint64_t byCrosses() {
    const int width = spec_.width, height = spec_.height;
    for (int y = 0; y <= height; ++y)
      for (int x = 0; x < width; ++x) {
        if (side_ == 1 || y == 0 || y == height - 1 || x == 0 || x == width - 1) {
          fill(x, y);
        } else {
          begin(x, y);
        }
      }
    std::uint64_t refined = 0;
    for (int y = 1; side_ > 1 && y < height; ++y) {
      for (bool changed = true; changed;) {
        changed = false;
        for (int x = 1; x + 1 < width; ++x) {
          const int cross[5][2] = {{x, y - 1}, {x - 1, y}, {x, y}, {x + 1, y}, {x, y + 1}};
          std::array<Color, 5> colors;
          for (std::size_t i = 0; i < 5; ++i) colors[i] = at(cross[i][0], cross[i][1]).color;
          if (!tooMuchContrast(colors, spec_.contrast)) continue;
          for (const auto& [cx, cy] : cross) {
            if (at(cx, cy).full) continue;
            fill(cx, cy);
            changed = true;
            if (cy < height) ++refined;
          }
        }
      }
    }
    return refined;
  }

  const PictureSpec& spec_;
  int side_;
  std::vector<double> weights_;
  std::vector<std::vector<Pixel>> lines_;
};
Reference reference(const PictureSpec& spec) { return WholeScreen(spec).refined(); }

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
