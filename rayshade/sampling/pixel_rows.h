// The pixels that are held: rows from the first one that is not taken, and what has come of each pixel.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <deque>
#include <memory>

#include "rayshade/sampling/sample_position.h"

namespace rayshade {

struct SamplerCounts {
  std::uint64_t needed = 0;        // samples that the rule asks for, whatever ran ahead
  std::uint64_t given = 0;         // samples that next() has given, some perhaps in vain
  std::uint64_t notFinite = 0;     // colours that were no finite numbers: black in their place
  std::uint64_t supersampled = 0;  // pixels that got all of their samples (none when there is one in a pixel)
};

// What does not change while a picture is sampled.
struct SamplingRules {
  PixelArea area;
  std::int32_t side = 1;  // of a pixel, in samples
  std::uint64_t seed = 0;
  std::uint32_t frame = 0;
  Color contrast;
  std::vector<double> weights;  // by cell
  std::uint64_t allCells = 1;   // one bit each
  bool refining = false;        // there are pixels with a single sample
  std::int32_t rowCount = 0;    // with the line below the picture, if it is traced
};
// Throws std::invalid_argument when pixelArea(spec) is nothing or there are not 1..8 samples per side.
SamplingRules samplingRules(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame);

struct Place {  // of a pixel, from the upper left of the area
  std::int32_t y, x;
  friend auto operator<=>(const Place&, const Place&) = default;
};

// Small: all pixels of a few dozen rows are held, and looked at again and again.
struct Pixel {
  Color first;                       // its first sample, which stands for all of it until it is refined
  std::uint64_t given = 0;           // cells, one bit each
  std::uint64_t come = 0;            // cells, one bit each
  std::unique_ptr<Color[]> samples;  // by cell, while they come; then all of them, filtered, in one
  std::uint8_t firstCell = 0;
  bool full = false;  // the rule demands all samples

  std::uint64_t firstBit() const { return std::uint64_t{1} << firstCell; }
  bool hasFirst() const { return (come & firstBit()) != 0; }
  // The colour when all samples have come: of one sample it is that.
  Color whole() const { return samples ? samples[0] : first; }
};

class PixelRows {
 public:
  explicit PixelRows(SamplingRules rules) : rules_(std::move(rules)) {}

  const SamplingRules& rules() const { return rules_; }
  SamplerCounts counts;

  std::int32_t first() const { return first_; }
  std::int32_t end() const { return first_ + static_cast<std::int32_t>(rows_.size()); }
  bool held(std::int32_t y) const { return y >= first_ && y < end(); }
  Pixel& at(Place place) { return rowOf(place).pixels[static_cast<std::size_t>(place.x)]; }
  const Pixel& at(Place place) const { return const_cast<PixelRows*>(this)->at(place); }
  bool isWhole(const Pixel& pixel) const { return pixel.come == rules_.allCells; }

  void add();  // the next row
  // All samples of a pixel are wanted.
  void demandAll(Place place) { demandAll(rowOf(place), at(place)); }
  // The colour of a sample.  Its place, if more is known of the pixel than before.
  std::optional<Place> supply(const SampleId& id, Color color);
  // The first row, and its memory is used again.  False: it still waits for samples.
  bool takeFirst(std::vector<Color>& colors);

 private:
  struct Row {
    std::vector<Pixel> pixels;
    std::int32_t incomplete = 0;  // full pixels that still wait for samples
  };

  void demandAll(Row& row, Pixel& pixel);
  Row& rowOf(Place place) { return rows_[static_cast<std::size_t>(place.y - first_)]; }
  Color filtered(const Pixel& pixel) const;

  SamplingRules rules_;
  std::deque<Row> rows_;
  std::int32_t first_ = 0;                 // the number of rows_[0]
  std::vector<std::vector<Pixel>> spare_;  // of rows that were taken
};

}  // namespace rayshade
