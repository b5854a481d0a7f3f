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

Cross crossAt(Place c, const PixelArea& screen) {
  const std::array<Place, 5> places{
      {{c.y - 1, c.x}, {c.y, c.x - 1}, {c.y, c.x}, {c.y, c.x + 1}, {c.y + 1, c.x}}};
  return {places, c.y + 1 < screen.height ? places.size() : places.size() - 1};
}

}  // namespace

bool tooMuchContrast(std::span<const Color> colors, Color threshold) {
  constexpr double kDark = 1e-5;  // of max + min: darker differences cannot be seen
  Color low = colors[0], high = colors[0];
  for (const Color& c : colors.subspan(1)) {
    low = {std::min(low.r, c.r), std::min(low.g, c.g), std::min(low.b, c.b)};
    high = {std::max(high.r, c.r), std::max(high.g, c.g), std::max(high.b, c.b)};
  }
  auto differ = [](double least, double most, double limit) {
    return most + least > kDark && (most - least) / (most + least) > limit;
  };
  return differ(low.r, high.r, threshold.r) || differ(low.g, high.g, threshold.g) ||
         differ(low.b, high.b, threshold.b);
}

CrossSweep::CrossSweep(const PixelRows& rows, std::int32_t bottom) : rowsEnd_(bottom) {
  const SamplingRules& rules = rows.rules();
  if (rules.refinement == Refinement::crosses) {
    left_ = rows.left() + 1;
    right_ = rows.right() - 1;
    top_ = rows.first() + 1;
    bottom_ = bottom - 1;
  } else {
    left_ = std::max(rows.left(), rules.wanted.x);
    right_ = std::min(rows.right(), rules.wanted.x + rules.wanted.width);
    top_ = std::max(rows.first(), rules.wanted.y);
    bottom_ = std::min(bottom, rules.wanted.y + rules.wanted.height);
  }
  next_ = {top_, left_};
  finished_ = !rules.refining() || left_ >= right_ || top_ >= bottom_;
}

void CrossSweep::decide(PixelRows& rows, std::deque<Place>& demanded) {
  const bool crosses = rows.rules().refinement == Refinement::crosses;
  while (!finished_ && (crosses ? decideCross(rows, demanded) : decideByNeighbours(rows, demanded))) {
    if (++next_.x < right_) continue;
    next_ = {changed_ ? next_.y : next_.y + 1, left_};
    changed_ = false;
    finished_ = next_.y >= bottom_;
  }
}

// Applies the rule to the cross that is next.  False: a colour that it needs has not come yet.
bool CrossSweep::decideCross(PixelRows& rows, std::deque<Place>& demanded) {
  if (!rows.held(next_.y + 1)) return false;
  const SamplingRules& rules = rows.rules();
  const Cross cross = crossAt(next_, rules.screen);
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

// The same for the pixel that is next.
bool CrossSweep::decideByNeighbours(PixelRows& rows, std::deque<Place>& demanded) {
  const Place low{std::max(next_.y - 1, rows.first()), std::max(next_.x - 1, rows.left())};
  const Place high{std::min(next_.y + 2, rowsEnd_), std::min(next_.x + 2, rows.right())};  // one beyond
  if (!rows.held(high.y - 1)) return false;
  std::array<Color, 8> colors;
  std::size_t count = 0;
  for (std::int32_t y = low.y; y < high.y; ++y)
    for (std::int32_t x = low.x; x < high.x; ++x) {
      if (y == next_.y && x == next_.x) continue;
      if (!rows.isBegun({y, x})) return false;
      colors[count++] = rows.first({y, x});
    }
  if (count > 0 && tooMuchContrast(std::span(colors).first(count), rows.rules().contrast) &&
      rows.demandAll(next_))
    demanded.push_back(next_);
  return true;
}

}  // namespace rayshade
