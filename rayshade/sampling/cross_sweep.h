// Which pixels are refined: the rule of adaptive supersampling (rayshade 4), applied in its order.
//
// Line y = 1, 2, .. is swept from left to right, again until a sweep changes nothing: where the cross of five pixels around
// (x, y) has too much contrast, all five get all of their samples.  A sweep sees what was refined just before, so decisions
// are taken strictly in this order, each as soon as the colours are known that it needs.
//
// The same sweep over a tile, a part of the picture, tells most of what the picture's sweep will refine there (tile_sampler.h):
// it does not see what is refined around the tile.
//
// Source of the test: Mitchell, Generating Antialiased Images at Low Sampling Densities, 1987.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/sampling/pixel_rows.h"

namespace rayshade {

// The test: colours are linear and unclamped.
bool tooMuchContrast(std::span<const Color, 5> cross, Color threshold);

class CrossSweep {
 public:
  // Over all columns of `rows` and the rows from the first one to `bottom` (one beyond), as they are held in turn.
  CrossSweep(const PixelRows& rows, std::int32_t bottom)
      : left_(rows.left() + 1),
        right_(rows.right() - 1),
        bottom_(bottom - 1),
        next_{rows.first() + 1, left_},
        finished_(left_ >= right_ || next_.y >= bottom_) {}

  // Decides as far as colours are known; places all of whose samples are demanded and have not come are added to `demanded`.
  void decide(PixelRows& rows, std::deque<Place>& demanded);
  bool finished() const { return finished_; }
  // No cross that is still to be decided touches this row.
  bool isPast(std::int32_t y) const { return finished_ || next_.y > y + 1; }

 private:
  bool decideNext(PixelRows& rows, std::deque<Place>& demanded);

  std::int32_t left_, right_, bottom_;  // of the centres of crosses; one beyond
  Place next_;                          // the centre of the next cross to decide
  bool changed_ = false;                // in this sweep
  bool finished_;
};

}  // namespace rayshade
