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

void CrossSweep::decide(PixelRows& rows, std::deque<Place>& demanded) {
  while (!finished_ && decideNext(rows, demanded)) {
    if (++next_.x < right_) continue;
    next_ = {changed_ ? next_.y : next_.y + 1, left_};
    changed_ = false;
    finished_ = next_.y >= bottom_;
  }
}

// Applies the rule to the cross that is next.  False: a colour that it needs has not come yet.
bool CrossSweep::decideNext(PixelRows& rows, std::deque<Place>& demanded) {
  if (!rows.held(next_.y + 1)) return false;
  const SamplingRules& rules = rows.rules();
  const Cross cross = crossAt(next_, rules.area);
  const auto refinable = std::span(cross.places).first(cross.refinable);
  // Nothing can change where all are full, whatever their colours: no need to wait for them.
  if (std::ranges::all_of(refinable, [&](Place p) { return rows.isFull(p); })) return true;

  std::array<Color, 5> colors;
  for (std::size_t i = 0; i < 5; ++i) {
    if (!rows.isKnown(cross.places[i])) return false;
    colors[i] = rows.color(cross.places[i]);
  }
  if (!tooMuchContrast(colors, rules.contrast)) return true;
  changed_ = true;
  for (const Place& place : refinable)
    if (rows.demandAll(place)) demanded.push_back(place);
  return true;
}

}  // namespace rayshade
