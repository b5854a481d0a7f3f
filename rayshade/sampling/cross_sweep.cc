// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/sampling/cross_sweep.h"

#include <algorithm>
#include <array>

namespace rayshade {
namespace {

// A pixel and its four neighbours; those that may be refined come first (the line below the picture may not).
struct Cross {
  std::array<Place, 5> places;
  std::size_t refinable;
};

Cross crossAt(Place c, const PixelArea& area) {
  const std::array<Place, 5> places{
      {{c.y - 1, c.x}, {c.y, c.x - 1}, {c.y, c.x}, {c.y, c.x + 1}, {c.y + 1, c.x}}};
  return {places, c.y + 1 < area.height ? places.size() : places.size() - 1};
}

}  // namespace

bool tooMuchContrast(std::span<const Color, 5> cross, Color threshold) {
  constexpr double kDark = 1e-5;  // of max + min: darker differences cannot be seen
  Color low = cross[0], high = cross[0];
  for (const Color& c : cross.subspan<1>()) {
    low = {std::min(low.r, c.r), std::min(low.g, c.g), std::min(low.b, c.b)};
    high = {std::max(high.r, c.r), std::max(high.g, c.g), std::max(high.b, c.b)};
  }
  auto differ = [](double least, double most, double limit) {
    return most + least > kDark && (most - least) / (most + least) > limit;
  };
  return differ(low.r, high.r, threshold.r) || differ(low.g, high.g, threshold.g) ||
         differ(low.b, high.b, threshold.b);
}

bool CrossSweep::isPast(std::int32_t y, const PixelRows& rows) const {
  // Crosses of the line below reach it; below the last line there are none.
  return next_.y > std::min(y + 1, rows.rules().area.height - 1);
}

void CrossSweep::decide(PixelRows& rows, std::deque<Place>& demanded) {
  const PixelArea& area = rows.rules().area;
  while (next_.y < area.height && decideNext(rows, demanded)) {
    if (++next_.x < area.width - 1) continue;
    next_ = {changed_ ? next_.y : next_.y + 1, 1};
    changed_ = false;
  }
}

// Applies the rule to the cross that is next.  False: a colour that it needs has not come yet.
bool CrossSweep::decideNext(PixelRows& rows, std::deque<Place>& demanded) {
  if (!rows.held(next_.y + 1)) return false;
  const SamplingRules& rules = rows.rules();
  const Cross cross = crossAt(next_, rules.area);
  const auto refinable = std::span(cross.places).first(cross.refinable);
  // Nothing can change where all are full, whatever their colours: no need to wait for them.
  if (std::ranges::all_of(refinable, [&](Place p) { return rows.at(p).full; })) return true;

  std::array<Color, 5> colors;
  for (std::size_t i = 0; i < 5; ++i) {
    const Pixel& pixel = rows.at(cross.places[i]);
    if (!(pixel.full ? rows.isWhole(pixel) : pixel.hasFirst())) return false;
    colors[i] = pixel.full ? pixel.whole() : pixel.first;
  }
  if (!tooMuchContrast(colors, rules.contrast)) return true;
  changed_ = true;
  for (const Place& place : refinable) {
    const Pixel& pixel = rows.at(place);
    if (pixel.full) continue;
    rows.demandAll(place);
    if (pixel.given != rules.allCells) demanded.push_back(place);
  }
  return true;
}

void CrossSweep::guess(const PixelRows& rows, Place place, std::set<Place>& guesses) const {
  const SamplingRules& rules = rows.rules();
  for (const Place& centre : crossAt(place, rules.area).places) {
    if (centre.y < next_.y || centre.y >= rules.area.height || centre.x < 1 ||
        centre.x >= rules.area.width - 1 || !rows.held(centre.y - 1) || !rows.held(centre.y + 1))
      continue;
    const Cross cross = crossAt(centre, rules.area);
    std::array<Color, 5> colors;
    const bool known = std::ranges::all_of(cross.places, [&, i = 0u](const Place& p) mutable {
      const Pixel& pixel = rows.at(p);
      colors[i++] = rows.isWhole(pixel) ? pixel.whole() : pixel.first;
      return pixel.hasFirst();
    });
    if (!known || !tooMuchContrast(colors, rules.contrast)) continue;
    for (const Place& p : std::span(cross.places).first(cross.refinable))
      if (rows.at(p).given != rules.allCells) guesses.insert(p);
  }
}

}  // namespace rayshade
