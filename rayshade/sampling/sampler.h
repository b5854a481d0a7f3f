// Which samples of the picture are wanted next, and what the pixels become of them.
//
// One state machine for the sequential renderer and for the tasks.  Tiles go out with nextTile(), their colours come back with
// supply() in any order, finished rows leave with takeRow().  The rows depend on the colours alone, never on the order or on
// how much is on the way.
//
// Adaptive supersampling: pixels first get one sample, chosen at random; by the rule of rayshade 4 row 0, the last row and the first
// and last column of the screen all of their side^2.  Then it is decided which of them get all of theirs (cross_sweep.h).  What is
// wanted may be a window of the screen: then what decides about its pixels is sampled, too, so that they are those of the whole.  Whoever traces a tile decides most of that (tile_sampler.h); the exact sweep
// over the picture trails behind, and nextSamples() gives what it finds missing.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/sampling/tile_sampler.h"

namespace rayshade {

// How much of a frame there is.
struct Completed {
  std::int32_t rows = 0, allRows = 0;
  std::uint64_t samples = 0, expected = 0;  // traced; in all, as far as can be told
};

class Sampler {
 public:
  static constexpr std::int32_t kTileSide = 32;  // pixels
  // So many samples that no tile has traced are worth being traced before the next tile, and together.
  static constexpr std::size_t kMany = 256;

  // Throws what samplingRules() throws.
  Sampler(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame,
          std::int32_t tileSide = kTileSide);

  const SamplingRules& rules() const { return rows_.rules(); }
  const PixelArea& area() const { return rules().area; }
  const SamplerCounts& counts() const { return rows_.counts; }
  // Taken is that the pixels that have not come will need as many samples as those that have.
  Completed completed() const;

  // The next tile, from top to bottom.  Nothing: all have been given, or rows must be taken first (rows that are not taken hold
  // back those far below, so that memory stays bounded).  Each tile is given once.
  std::optional<Tile> nextTile();
  // The colours of a tile that was given and has not come before.  Requires fit(colors, tile).
  void supply(const Tile& tile, const TileColors& colors);

  // Samples that no tile has traced and that are needed: puts them into `out` and says how many.  Each is given once.
  std::size_t nextSamples(std::span<SampleId> out);
  std::size_t missing() const;  // how many there are now
  // The colour of one of them.  One that has come before or is no longer of use is ignored.
  void supply(const SampleId& id, Color color);

  // The next finished row, from top to bottom.  Ends the use of its samples.
  bool takeRow(std::vector<Color>& row);

  // All rows have been taken; what is still on the way is of no use.
  bool finished() const { return rows_.first() >= rules().wanted.y + rules().wanted.height; }

 private:
  PixelRows rows_;
  CrossSweep sweep_;
  std::int32_t tileSide_;
  std::int32_t rowsAhead_;  // how far rows are held beyond the first that is not taken
  Tile next_;               // its place; the size follows from it
  std::uint64_t comeInside_ = 0, comeOnBorder_ = 0;  // pixels
  std::deque<Place> demanded_;  // pixels whose other samples are still to be given, in order of decision
  std::int32_t cell_ = 0;       // the next one of the first of them
};

}  // namespace rayshade
