// The samples of a tile: a rectangle of pixels, the unit of work of all who trace.
//
// First samples first, then those of the pixels that the rule refines (cross_sweep.h) as far as the tile alone can tell: crosses
// that reach beyond it are left to the picture's own sweep, which is exact and asks for what is missing (sampler.h).  So hardly
// a sample is traced in vain, nothing is traced twice, and nobody has to wait for decisions about other tiles.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/sampling/cross_sweep.h"

namespace rayshade {

struct Tile {
  std::int32_t x = 0, y = 0, width = 0, height = 0;  // pixels, from the upper left of the area
  friend bool operator==(const Tile&, const Tile&) = default;
};

// What becomes of a tile.
struct TileColors {
  std::vector<Color> first;         // by pixel, row by row: its first sample
  std::vector<std::uint32_t> full;  // pixels of which all samples were traced, ascending
  std::vector<Color> whole;         // what became of these, filtered
  std::uint32_t samples = 0;        // traced
  std::uint32_t notFinite = 0;      // of those, black in their place
};

// Could these be the colours of such a tile?
bool fit(const TileColors& colors, const Tile& tile);

class TileSampler {
 public:
  // Requires a tile of at least one pixel inside of the rows and columns that are sampled.
  TileSampler(const SamplingRules& rules, const Tile& tile);

  const SamplingRules& rules() const { return rows_.rules(); }
  const Tile& tile() const { return tile_; }
  // Puts samples to be traced into `out` and says how many; none: wait for colours, or all have been given.  Neighbours come close
  // together: blocks of 8 x 8 pixels, all cells of a pixel in a row.
  std::size_t next(std::span<SampleId> out);
  // The colour of a sample that was given.  False: it has come before, or is none of these.
  bool supply(const SampleId& id, Color color);
  // Everything has been traced.
  bool finished() const { return awaited_ == 0 && allBegun() && demanded_.empty() && sweep_.finished(); }
  TileColors colors() const;

 private:
  bool allBegun() const { return begin_.y >= tile_.y + tile_.height; }
  bool give(SampleId& out);
  bool giveBegin(SampleId& out);
  void skipUnasked();
  void stepBegin();

  Tile tile_;
  PixelRows rows_;
  CrossSweep sweep_;
  Place begin_;                 // the next pixel to get its first sample, or all if all are asked for
  std::int32_t cell_ = 0;       // the next one of that pixel, or of the first demanded one
  std::deque<Place> demanded_;  // pixels whose other samples are still to be given
  std::uint32_t given_ = 0, awaited_ = 0;
};

}  // namespace rayshade
