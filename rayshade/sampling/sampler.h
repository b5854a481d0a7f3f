// Which samples of the picture are wanted next, and what the pixels become of them.
//
// One state machine for the sequential renderer and for the tasks: samples go out with next(), their colours
// come back with supply() in any order, finished rows leave with takeRow().  The rows depend on the colours
// alone, never on the order or on how many samples are on the way.
//
// Adaptive supersampling (rayshade 4): row 0, the last row and the first and last column get all of their
// side^2 samples, every other pixel first gets one in a cell chosen at random.  Then it is decided which of them get all
// of theirs (cross_sweep.h), in a strict order; only the tracing runs ahead.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/sampling/cross_sweep.h"

namespace rayshade {

// How much of a frame there is.
struct Completed {
  std::int32_t rows = 0, allRows = 0;
  std::uint64_t samples = 0, expected = 0;  // given out; in all, as far as can be told
};

class Sampler {
 public:
  // Whether pixels that will probably be refined are asked for before that is decided: pays when there are
  // many samples on the way (a few percent are traced in vain), needless when they are traced one by one.
  enum class Guessing : bool { no, yes };

  // Throws what samplingRules() throws.
  Sampler(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame,
          Guessing guessing = Guessing::yes);

  const PixelArea& area() const { return rows_.rules().area; }
  const SamplerCounts& counts() const { return rows_.counts; }
  // Taken is that the pixels that have not begun will need as many samples as those that have.
  Completed completed() const;

  // Puts samples to be traced into `out` and says how many.  None: wait for colours or take rows first (rows
  // that are not taken hold back those far below, so that memory stays bounded).  Each sample is given once.
  // Neighbours come close together: blocks of 8 x 8 pixels, all cells of a pixel in a row.
  std::size_t next(std::span<SampleId> out);
  bool next(SampleId& out) { return next(std::span(&out, 1)) == 1; }

  // The colour of a sample.  One that was not given out, has come before or is no longer of use is ignored.
  void supply(const SampleId& id, Color color);

  // The next finished row, from top to bottom.  Ends the use of its samples.
  bool takeRow(std::vector<Color>& row);

  // All rows have been taken; samples still on the way are of no use.
  bool finished() const { return rows_.first() == area().height; }

 private:
  bool give(SampleId& out);
  bool giveCell(Pixel& pixel, Place place, SampleId& out);
  bool giveAhead(SampleId& out);
  void stepAhead();

  PixelRows rows_;
  CrossSweep sweep_;
  bool guessing_;
  std::int32_t rowsAhead_;  // how far rows are held beyond the first that is not taken
  std::uint64_t begunInside_ = 0, begunOnBorder_ = 0;  // pixels
  Place ahead_{0, 0};           // the next pixel to get its first sample, or all if it is on the border
  std::deque<Place> demanded_;  // full pixels that are not given completely, in order of decision
  std::set<Place> guesses_;     // pixels that are probably full some day
};

}  // namespace rayshade
