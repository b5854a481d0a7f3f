// Which pixels are refined, which means that they get all of their samples.
//
// Neighbours: a pixel whose up to eight neighbours have too much contrast with each other, by the first sample of each.  Its own
// samples do not decide about it, so its value has no bias: a single sample is right on the average, and so are all of them.
//
// Crosses: the rule of adaptive supersampling of rayshade 4, applied in its order.  Line y = 1, 2, .. is swept from left to right,
// again until a sweep changes nothing: where the cross of five pixels around (x, y) has too much contrast, all five get all of
// their samples.  A sweep sees what was refined just before, so decisions are taken strictly in this order, each as soon as the
// colours are known that it needs.  A pixel whose first sample misses what is smaller than a pixel stays as it is, one whose first
// sample meets it does not: so light is lost, the more the more samples there are.
//
// The same sweep over a tile, a part of the picture, tells most of what the picture's sweep will refine there (tile_sampler.h):
// it does not see what is around the tile.
//
// Source of the test: Mitchell, Generating Antialiased Images at Low Sampling Densities, 1987; of the bias of such rules: Kirk &
// Arvo, Unbiased Sampling Techniques for Image Synthesis, 1991.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/sampling/pixel_rows.h"

namespace rayshade {

// The test: colours are linear and unclamped.
bool tooMuchContrast(std::span<const Color> colors, Color threshold);

class CrossSweep {
 public:
  // Over all columns of `rows` and the rows from the first one to `bottom` (one beyond), as they are held in turn.
  CrossSweep(const PixelRows& rows, std::int32_t bottom);

  // Decides as far as colours are known; places all of whose samples are demanded and have not come are added to `demanded`.
  void decide(PixelRows& rows, std::deque<Place>& demanded);
  bool finished() const { return finished_; }
  // No pixel or cross that is still to be decided touches this row.
  bool isPast(std::int32_t y) const { return finished_ || next_.y > y + 1; }

 private:
  bool decideCross(PixelRows& rows, std::deque<Place>& demanded);
  bool decideByNeighbours(PixelRows& rows, std::deque<Place>& demanded);

  std::int32_t left_, right_, top_, bottom_;  // of pixels, or of the middles of crosses; one beyond
  std::int32_t rowsEnd_;                      // of the rows that will be held
  Place next_;                                // the next one to decide
  bool changed_ = false;                      // in this sweep
  bool finished_;
};

}  // namespace rayshade
