// Small pictures, sampled in any order, and what the plain rules make of them with all of the screen in memory.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <variant>

#include "rayshade/sampling/filter.h"
#include "tests/support/traced_tile.h"

namespace rayshade {

using Rows = std::vector<std::vector<Color>>;
inline constexpr std::uint64_t kSeed = 7;
inline constexpr std::uint32_t kFrame = 3;

// A scene: edges, a fine pattern that refines again and again, smooth parts, black, light above 1.
inline Color colorOf(const PictureSpec& spec, const SampleId& id) {
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
inline Reference reference(const PictureSpec& spec) { return WholeScreen(spec).refined(); }

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
inline TileColors traceTile(const PictureSpec& spec, const Tile& tile, std::size_t window,
                            const Order& order) {
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

inline Rows run(const PictureSpec& spec, std::size_t window, const Order& order, std::int32_t tileSide,
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

inline std::size_t oldest(std::size_t) { return 0; }
inline std::size_t newest(std::size_t count) { return count - 1; }

}  // namespace rayshade
