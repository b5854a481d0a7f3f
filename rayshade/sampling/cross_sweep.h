// Which pixels are refined: the rule of adaptive supersampling (rayshade 4), applied in its order.
//
// Line y = 1, 2, .. is swept from left to right, again until a sweep changes nothing: where the cross of five pixels around
// (x, y) has too much contrast, all five get all of their samples.  A sweep sees what was refined just before, so decisions
// are taken strictly in this order, each as soon as the colours are known that it needs.
//
// Source of the test: Mitchell, Generating Antialiased Images at Low Sampling Densities, 1987.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>

#include "rayshade/sampling/pixel_rows.h"

namespace rayshade {

// The test: colours are linear and unclamped.
bool tooMuchContrast(std::span<const Color, 5> cross, Color threshold);

class CrossSweep {
 public:
  // Decides as far as colours are known; full pixels that have not been given completely are added to `demanded`.
  void decide(PixelRows& rows, std::deque<Place>& demanded);
  // A colour of this pixel is new: adds to `guesses` what its crosses would refine by what is known now.
  void guess(const PixelRows& rows, Place place, std::set<Place>& guesses) const;
  // No cross that is still to be decided touches this row.
  bool isPast(std::int32_t y, const PixelRows& rows) const;

 private:
  bool decideNext(PixelRows& rows, std::deque<Place>& demanded);

  Place next_{1, 1};      // the centre of the next cross to decide
  bool changed_ = false;  // in this sweep
};

}  // namespace rayshade
