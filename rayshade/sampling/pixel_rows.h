// The pixels that are held, of the whole width of a picture or of a part of it: what has come of each.
//
// Arrays of colours, row by row: of each pixel its first sample, and the whole of it once all of its samples have come.  While
// samples of a pixel come one by one, they are kept apart until the last has come.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <deque>
#include <span>
#include <unordered_map>
#include <vector>

#include "rayshade/sampling/sample_position.h"

namespace rayshade {

struct SamplerCounts {
  std::uint64_t needed = 0;        // samples that the rule asks for, whatever ran ahead
  std::uint64_t given = 0;         // samples that were traced or given out to be, some perhaps in vain
  std::uint64_t notFinite = 0;     // colours that were no finite numbers: black in their place
  std::uint64_t supersampled = 0;  // pixels that got all of their samples (none when there is one in a pixel)
};

// What does not change while a picture is sampled.
struct SamplingRules {
  PixelArea area;    // what is sampled of the screen: what is wanted, and what decides about it
  PixelArea wanted;  // from the upper left of the area, as the next
  PixelArea screen;
  std::int32_t side = 1;  // of a pixel, in samples
  std::uint64_t seed = 0;
  std::uint32_t frame = 0;
  Color contrast;
  std::vector<double> weights;  // by cell
  Refinement refinement = Refinement::all;
  std::int32_t rowCount = 0;  // of the area, with the line below the picture, if it is traced

  std::int32_t cells() const { return side * side; }
  bool refining() const { return refinement != Refinement::all; }  // there are pixels with a single sample
};
// Throws std::invalid_argument when pixelArea(spec) is nothing or there are not 1..64 samples per side.
SamplingRules samplingRules(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame);

struct Place {  // of a pixel, from the upper left of the area
  std::int32_t y, x;
  friend auto operator<=>(const Place&, const Place&) = default;
};

// What is asked of a pixel before anything is known of it.
enum class Asked : std::uint8_t { nothing, first, all };
Asked askedOf(const SamplingRules& rules, Place place);
std::uint64_t pixelsAskedForAll(const SamplingRules& rules);
// The cell of the first sample: 0 where all are asked for, else chosen at random.
std::int32_t firstCell(const SamplingRules& rules, Place place);
inline SampleId sampleAt(const SamplingRules& rules, Place place, std::int32_t cell) {
  return {rules.area.x + place.x, rules.area.y + place.y, cell};
}

class PixelRows {
 public:
  // Columns left .. left + width - 1, from row `top` on; no row is held yet.
  PixelRows(SamplingRules rules, std::int32_t left, std::int32_t width, std::int32_t top = 0)
      : rules_(std::move(rules)), left_(left), width_(width), first_(top) {}

  const SamplingRules& rules() const { return rules_; }
  SamplerCounts counts;

  std::int32_t left() const { return left_; }
  std::int32_t right() const { return left_ + width_; }  // one beyond
  std::int32_t first() const { return first_; }
  std::int32_t end() const { return first_ + static_cast<std::int32_t>(rows_.size()); }
  bool held(std::int32_t y) const { return y >= first_ && y < end(); }

  // Requires that the row of the place is held, as all that follows.
  bool isFull(Place place) const { return has(place, kFull); }    // all of its samples are demanded
  bool isWhole(Place place) const { return has(place, kWhole); }  // and have come
  bool isBegun(Place place) const { return has(place, kFirst); }  // its first sample has come
  bool isKnown(Place place) const { return has(place, isFull(place) ? kWhole : kFirst); }
  Color color(Place place) const {
    return isFull(place) ? whole(place) : first(place);
  }  // of one that is known
  Color first(Place place) const { return row(place.y).first[column(place)]; }
  Color whole(Place place) const { return row(place.y).whole[column(place)]; }

  void add();  // the next row
  // All samples of a pixel are demanded.  False: they were before, or have come already.
  bool demandAll(Place place);
  // The colour of a sample.  False: it has come before or does not belong here, and is ignored.
  bool supply(const SampleId& id, Color color);
  // The same for a first sample, and for all samples of a pixel, filtered.
  void supplyFirst(Place place, Color color);
  void supplyWhole(Place place, Color color);
  // The first row, and its memory is used again.  False: it still waits for samples.
  bool takeFirst(std::vector<Color>& colors);

 private:
  static constexpr std::uint8_t kFirst = 1, kWhole = 2, kFull = 4;
  struct Row {
    std::vector<Color> first, whole;
    std::vector<std::uint8_t> flags;
    std::int32_t incomplete = 0;  // pixels whose colour is not known
  };
  struct Cells {
    std::int32_t count = 0;  // that have come
    std::vector<bool> come;
    std::vector<Color> colors;
  };

  const Row& row(std::int32_t y) const { return rows_[static_cast<std::size_t>(y - first_)]; }
  Row& row(std::int32_t y) { return rows_[static_cast<std::size_t>(y - first_)]; }
  std::size_t column(Place place) const { return static_cast<std::size_t>(place.x - left_); }
  bool has(Place place, std::uint8_t flag) const { return (row(place.y).flags[column(place)] & flag) != 0; }
  Color finite(Color color);

  SamplingRules rules_;
  std::int32_t left_, width_;
  std::deque<Row> rows_;
  std::int32_t first_;                             // the number of rows_[0]
  std::unordered_map<std::uint64_t, Cells> come_;  // samples of pixels of which not all have come
  std::vector<Row> spare_;                         // rows that were taken
};

}  // namespace rayshade
