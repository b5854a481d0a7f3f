// Which samples of the picture are wanted next, and what the pixels become of them.
//
// One state machine for the sequential renderer and for the tasks: samples go out with next(), their colours
// come back with supply() in any order, finished rows leave with takeRow().  The rows depend on the colours
// alone, never on the order or on how many samples are on the way.
//
// Adaptive supersampling (rayshade 4): row 0, the last row and the first and last column get all of their
// side^2 samples, every other pixel first gets one in a cell chosen at random.  Then line y = 1, 2, .. is
// swept from left to right, again until a sweep changes nothing: where the cross of five pixels around (x, y)
// has too much contrast, all five get all of their samples.  A sweep sees what was refined just before, so
// decisions are taken strictly in this order; only the tracing runs ahead.
//
// Source of the test: Mitchell, Generating Antialiased Images at Low Sampling Densities, 1987.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <set>
#include <span>
#include <vector>

#include "rayshade/base/color.h"
#include "rayshade/base/random.h"
#include "rayshade/sampling/picture_spec.h"

namespace rayshade {

struct SampleId {
  std::int32_t x = 0, y = 0;  // pixel of the screen, from the upper left; y may be one line below the screen
  std::int32_t cell = 0;      // of the pixel: column + row * side

  friend bool operator==(const SampleId&, const SampleId&) = default;
};

template <class Archive>
void serialize(Archive& archive, SampleId& s) {
  archive(s.x, s.y, s.cell);
}

// Where and when a sample is taken.
struct SamplePosition {
  double u = 0, v = 0;    // on the screen                                     [pixels]
  double time = 0;        // scene time
  std::int32_t side = 1;  // of the pixel, in samples
  std::int32_t number =
      0;            // stratum of lens, time, lights and gloss: column number % side, row number / side
  RandomKey key{};  // of the sample: all that is random about its rays comes from it
};

// Where the ray of a sample goes through the lens, in the square [-1, 1]^2.
struct LensPosition {
  double x = 0, y = 0;
};
LensPosition lensPosition(const SamplePosition& at);

// The stratum of a cell; side is 1..8, cell 0..side^2-1.  As in rayshade 4 the numbers start from 1 for sides
// 6, 7 and 8, so one cell of each pixel has the number side^2, just outside of the square of strata.
std::int32_t sampleNumber(std::int32_t side, std::int32_t cell);

// A pure function: any task gets the same position.  `frame` counts from 0 at spec.startTime.
SamplePosition samplePosition(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame,
                              const SampleId& id);

// The same for many samples of one frame; `positions` is as long as `ids`.
void samplePositions(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame,
                     std::span<const SampleId> ids, std::span<SamplePosition> positions);

// The test of adaptive supersampling: colours are linear and unclamped.
bool tooMuchContrast(std::span<const Color, 5> cross, Color threshold);

struct SamplerCounts {
  std::uint64_t needed = 0;        // samples that the rule asks for, whatever ran ahead
  std::uint64_t given = 0;         // samples that next() has given, some perhaps in vain
  std::uint64_t supersampled = 0;  // pixels that got all of their samples (none when there is one in a pixel)
};

class Sampler {
 public:
  // Whether pixels that will probably be refined are asked for before that is decided: pays when there are
  // many samples on the way (a few percent are traced in vain), needless when they are traced one by one.
  enum class Guessing : bool { no, yes };

  // Throws std::invalid_argument when pixelArea(spec) is nothing or there are not 1..8 samples per side.
  Sampler(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame,
          Guessing guessing = Guessing::yes);

  const PixelArea& area() const { return area_; }
  const SamplerCounts& counts() const { return counts_; }

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
  bool finished() const { return firstRow_ == area_.height; }

 private:
  // Small: all pixels of a few dozen rows are held, and looked at again and again.
  struct Pixel {
    Color first;                       // its first sample, which stands for all of it until it is refined
    std::uint64_t given = 0;           // cells, one bit each
    std::uint64_t come = 0;            // cells, one bit each
    std::unique_ptr<Color[]> samples;  // by cell, while they come; then all of them, filtered, in one
    std::uint8_t firstCell = 0;
    bool full = false;  // the rule demands all samples
  };
  struct Row {
    std::vector<Pixel> pixels;
    std::int32_t incomplete = 0;  // full pixels that still wait for samples
  };
  struct Place {  // from the upper left of the area
    std::int32_t y, x;
    friend auto operator<=>(const Place&, const Place&) = default;
  };

  // A pixel and its four neighbours; those that may be refined come first (the line below the picture may
  // not).
  struct Cross {
    std::array<Place, 5> places;
    std::size_t refinable;
  };

  bool give(SampleId& out);
  bool givePixel(Place place, Pixel& pixel, SampleId& out);
  bool giveAhead(SampleId& out);
  void stepAhead();
  void addRows();
  void demandAll(Pixel& pixel, Row& row);
  bool decide(Place centre);
  void nextCross();
  void guessAround(Place place);
  Cross crossAt(Place centre) const;
  Color filtered(const Pixel& pixel) const;

  bool held(std::int32_t y) const {
    return y >= firstRow_ && y < firstRow_ + static_cast<std::int32_t>(rows_.size());
  }
  Row& rowOf(Place place) { return rows_[static_cast<std::size_t>(place.y - firstRow_)]; }
  Pixel& at(Place place) { return rowOf(place).pixels[static_cast<std::size_t>(place.x)]; }
  static std::uint64_t firstBit(const Pixel& pixel) { return std::uint64_t{1} << pixel.firstCell; }
  static bool hasFirst(const Pixel& pixel) { return (pixel.come & firstBit(pixel)) != 0; }
  bool isWhole(const Pixel& pixel) const { return pixel.come == allCells_; }
  // The colour of a whole pixel: of one sample it is that.
  static Color wholeOf(const Pixel& pixel) { return pixel.samples ? pixel.samples[0] : pixel.first; }

  PixelArea area_;
  std::int32_t side_;
  std::uint64_t seed_;
  std::uint32_t frame_;
  Color contrast_;
  bool guessing_;
  std::vector<double> weights_;
  std::uint64_t allCells_;

  bool refining_;           // there are pixels with a single sample
  std::int32_t rowCount_;   // with the line below the picture, if it is traced
  std::int32_t rowsAhead_;  // how far rows are held beyond the first that is not taken

  std::deque<Row> rows_;                   // those that are held
  std::int32_t firstRow_ = 0;              // the number of rows_[0]
  std::vector<std::vector<Pixel>> spare_;  // of rows that were taken: their memory is used again

  Place ahead_{0, 0};           // the next pixel to get its first sample, or all if it is on the border
  Place line_{1, 1};            // the next cross to decide
  bool changed_ = false;        // in this sweep
  std::deque<Place> demanded_;  // full pixels that are not given completely, in order of decision
  std::set<Place> guesses_;     // pixels that are probably full some day
  SamplerCounts counts_;
};

}  // namespace rayshade
