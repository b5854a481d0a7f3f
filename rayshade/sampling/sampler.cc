// The sampler; what it does and why is in sampler.h.
//
// What may run ahead of the decisions: first samples, always needed, up to rowsAhead_ rows below the first
// row that was not taken; then guesses.  Decided pixels go first, because rows wait for them.
//
// The line below the picture: line y is refined after line y + 1 has its first samples, and rayshade 4 traces
// one line more so that this holds for the last line too.  The pixels of the last line have all samples
// anyway, but its crosses reach up to the last line but one, which they may refine.  So the first samples of
// the extra line can be seen in the picture.  More of its samples cannot: an extra pixel belongs to one cross
// only, and when it would be refined that cross is full.
//
// differs from rayshade4: the extra line gets one sample per pixel at most, and none at its two ends.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/sampling/sampler.h"

#include <algorithm>
#include <array>
#include <bit>
#include <stdexcept>

#include "rayshade/sampling/filter.h"

namespace rayshade {
namespace {

constexpr std::int32_t kBlock = 8;  // pixels: the side of a block of first samples
// Pixels held below the first row that is not taken, when rows are short.
constexpr std::int32_t kPixelsAhead = 1 << 14;
constexpr std::int32_t kRowsAhead = 3 * kBlock;  // at least, however long the rows are

// The cell of a pixel's first sample has a key of its own, apart from those of the cells.
constexpr std::uint32_t kNoCell = 0xffffffffu;

// Magic squares and the like by column + row * side; facts of rayshade 4.
constexpr std::uint8_t kNumbers1[] = {0};
constexpr std::uint8_t kNumbers2[] = {0, 2, 3, 1};
constexpr std::uint8_t kNumbers3[] = {0, 2, 7, 6, 5, 1, 3, 8, 4};
constexpr std::uint8_t kNumbers4[] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
constexpr std::uint8_t kNumbers5[] = {0, 8, 23, 17, 2,  19, 12, 4,  20, 15, 3,  21, 16,
                                      9, 6, 14, 10, 24, 1,  13, 22, 7,  18, 11, 5};
constexpr std::uint8_t kNumbers6[] = {6,  32, 3,  34, 35, 1,  7,  11, 27, 28, 8,  30, 24, 14, 16, 15, 23, 19,
                                      13, 20, 22, 21, 17, 18, 25, 29, 10, 9,  26, 12, 36, 5,  33, 4,  2,  31};
constexpr std::uint8_t kNumbers7[] = {22, 47, 16, 41, 10, 35, 4,  5,  23, 48, 17, 42, 11, 29, 30, 6,  24,
                                      49, 18, 36, 12, 13, 31, 7,  25, 43, 19, 37, 38, 14, 32, 1,  26, 44,
                                      20, 21, 39, 8,  33, 2,  27, 45, 46, 15, 40, 9,  34, 3,  28};
constexpr std::uint8_t kNumbers8[] = {8,  58, 59, 5,  4,  62, 63, 1,  49, 15, 14, 52, 53, 11, 10, 56,
                                      41, 23, 22, 44, 45, 19, 18, 48, 32, 34, 35, 29, 28, 38, 39, 25,
                                      40, 26, 27, 37, 36, 30, 31, 33, 17, 47, 46, 20, 21, 43, 42, 24,
                                      9,  55, 54, 12, 13, 51, 50, 16, 64, 2,  3,  61, 60, 6,  7,  57};
constexpr std::span<const std::uint8_t> kNumbers[] = {kNumbers1, kNumbers2, kNumbers3, kNumbers4,
                                                      kNumbers5, kNumbers6, kNumbers7, kNumbers8};

}  // namespace

std::int32_t sampleNumber(std::int32_t side, std::int32_t cell) {
  return kNumbers[side - 1][static_cast<std::size_t>(cell)];
}

namespace {

// What the samples of a frame have in common.
struct SampleGrid {
  std::int32_t side;
  bool jitter;
  double width, cell;  // of the filter, of a cell of a pixel                                        [pixels]
  double opens, stratum;  // of a sample in time; 0: all are taken when the shutter opens         [scene time]
  RandomKey key;

  SampleGrid(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame)
      : side(spec.samplesPerSide),
        jitter(spec.jitter),
        width(spec.filter.width),
        cell(width / side),
        opens(spec.startTime + frame * spec.frameLength),
        stratum(spec.shutter > 0 ? spec.shutter / (side * side) : 0),
        key(frameKey(seed, frame)) {}

  // The pixel (x, y) is the square of the filter's width around the screen position (x, y), not around its middle: so
  // does rayshade 4.  Without jitter a sample sits in the upper left corner of its cell.
  SamplePosition operator()(const SampleId& id) const {
    SamplePosition at;
    at.key = sampleKey(key, static_cast<std::uint32_t>(id.x), static_cast<std::uint32_t>(id.y),
                       static_cast<std::uint32_t>(id.cell));
    at.side = side;
    at.number = side == 1 ? 0 : sampleNumber(side, id.cell);
    auto jittered = [&](Dimension dimension) { return jitter ? uniform(at.key, dimension) : 0.0; };
    const std::int32_t row = side == 1 ? 0 : id.cell / side, column = id.cell - row * side;
    at.u = id.x - width / 2 + (column + jittered(Dimension::jitterX)) * cell;
    at.v = id.y - width / 2 + (row + jittered(Dimension::jitterY)) * cell;
    at.time = opens;
    if (stratum > 0) at.time += stratum * (at.number + jittered(Dimension::time));
    return at;
  }
};

}  // namespace

SamplePosition samplePosition(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame,
                              const SampleId& id) {
  return SampleGrid(spec, seed, frame)(id);
}

void samplePositions(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame,
                     std::span<const SampleId> ids, std::span<SamplePosition> positions) {
  const SampleGrid grid(spec, seed, frame);
  for (std::size_t i = 0; i < ids.size(); ++i) positions[i] = grid(ids[i]);
}

// The lens is always jittered: without it there would be side^2 sharp pictures on top of each other.
LensPosition lensPosition(const SamplePosition& at) {
  return {2 * (at.number % at.side + uniform(at.key, Dimension::lensX)) / at.side - 1,
          2 * (at.number / at.side + uniform(at.key, Dimension::lensY)) / at.side - 1};
}

bool tooMuchContrast(std::span<const Color, 5> cross, Color threshold) {
  constexpr double kDark = 1e-5;  // of max + min: darker differences cannot be seen
  Color low = cross[0], high = cross[0];
  for (const Color& c : cross.subspan<1>()) {
    low = {std::min(low.r, c.r), std::min(low.g, c.g), std::min(low.b, c.b)};
    high = {std::max(high.r, c.r), std::max(high.g, c.g), std::max(high.b, c.b)};
  }
  auto differ = [](double least, double most, double limit) {
    return most + least > kDark && (most - least) / (most + least) > limit;
  };
  return differ(low.r, high.r, threshold.r) || differ(low.g, high.g, threshold.g) ||
         differ(low.b, high.b, threshold.b);
}

Sampler::Sampler(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame, Guessing guessing)
    : side_(spec.samplesPerSide),
      seed_(seed),
      frame_(frame),
      contrast_(spec.contrast),
      guessing_(guessing == Guessing::yes) {
  const auto area = pixelArea(spec);
  if (!area)
    throw std::invalid_argument("the window is not on the screen, or the screen is empty or too large");
  if (side_ < 1 || side_ > kMaxSamplesPerSide)
    throw std::invalid_argument("there must be 1 to 8 samples per side of a pixel");
  area_ = *area;
  weights_ = filterWeights(spec.filter, side_);
  allCells_ = ~std::uint64_t{0} >> (64 - side_ * side_);
  refining_ = side_ > 1 && area_.width > 2 && area_.height > 2;
  rowCount_ = area_.height + (refining_ ? 1 : 0);
  rowsAhead_ = std::max(kRowsAhead, kPixelsAhead / area_.width);
}

std::size_t Sampler::next(std::span<SampleId> out) {
  std::size_t count = 0;
  while (count < out.size() && give(out[count])) ++count;
  counts_.given += count;
  return count;
}

bool Sampler::give(SampleId& out) {
  if (finished()) return false;
  if (!demanded_.empty()) {
    const Place place = demanded_.front();
    Pixel& pixel = at(place);
    givePixel(place, pixel, out);
    if (pixel.given == allCells_) demanded_.pop_front();
    return true;
  }
  if (giveAhead(out)) return true;
  for (; !guesses_.empty(); guesses_.erase(guesses_.begin()))
    if (givePixel(*guesses_.begin(), at(*guesses_.begin()), out)) return true;
  return false;
}

// The first cell of a pixel that has not been given yet.
bool Sampler::givePixel(Place place, Pixel& pixel, SampleId& out) {
  if (pixel.given == allCells_) return false;
  const int cell = std::countr_one(pixel.given);
  pixel.given |= std::uint64_t{1} << cell;
  out = {area_.x + place.x, area_.y + place.y, cell};
  return true;
}

// All samples of a pixel of the border, the first of any other, band by band and block by block.
bool Sampler::giveAhead(SampleId& out) {
  bool found = false;
  while (!found && ahead_.y < rowCount_) {
    if (!held(ahead_.y)) {
      if (ahead_.y - firstRow_ >= rowsAhead_) return false;
      addRows();
    }
    const Place place = ahead_;
    Pixel& pixel = at(place);
    const bool idle = place.y == area_.height && (place.x == 0 || place.x == area_.width - 1);
    if (pixel.full) {
      found = givePixel(place, pixel, out);
    } else if (!idle) {
      found = true;
      pixel.given = firstBit(pixel);
      out = {area_.x + place.x, area_.y + place.y, pixel.firstCell};
    }
    if (!pixel.full || pixel.given == allCells_) stepAhead();
  }
  return found;
}

void Sampler::stepAhead() {
  const std::int32_t band = ahead_.y / kBlock * kBlock, bandEnd = std::min(band + kBlock, rowCount_);
  const std::int32_t block = ahead_.x / kBlock * kBlock, blockEnd = std::min(block + kBlock, area_.width);
  if (++ahead_.x < blockEnd) return;
  ahead_.x = block;
  if (++ahead_.y < bandEnd) return;
  ahead_ = blockEnd < area_.width ? Place{band, blockEnd} : Place{bandEnd, 0};
}

// The next band.
void Sampler::addRows() {
  const std::int32_t cells = side_ * side_;
  const std::int32_t begin = firstRow_ + static_cast<std::int32_t>(rows_.size());
  const std::int32_t end = std::min(begin + kBlock, rowCount_);
  for (std::int32_t y = begin; y < end; ++y) {
    Row& row = rows_.emplace_back();
    if (!spare_.empty()) {
      row.pixels = std::move(spare_.back());
      spare_.pop_back();
    }
    row.pixels.clear();
    row.pixels.resize(static_cast<std::size_t>(area_.width));
    for (std::int32_t x = 0; x < area_.width; ++x) {
      Pixel& pixel = row.pixels[static_cast<std::size_t>(x)];
      const bool side = x == 0 || x == area_.width - 1, end = y == 0 || y == area_.height - 1;
      if (y < area_.height && (side || end || !refining_)) {
        demandAll(pixel, row);
      } else if (!side) {
        ++counts_.needed;
        if (cells == 1) continue;
        const RandomKey key = sampleKey(seed_, frame_, static_cast<std::uint32_t>(area_.x + x),
                                        static_cast<std::uint32_t>(area_.y + y), kNoCell);
        pixel.firstCell = static_cast<std::uint8_t>(uniform(key, Dimension::firstCell) * cells);
      }
    }
  }
}

void Sampler::demandAll(Pixel& pixel, Row& row) {
  pixel.full = true;
  if (!isWhole(pixel)) ++row.incomplete;
  const bool firstCounted = (pixel.given & firstBit(pixel)) != 0;
  counts_.needed += static_cast<std::uint64_t>(side_ * side_ - firstCounted);
  if (side_ > 1) ++counts_.supersampled;
}

void Sampler::supply(const SampleId& id, Color color) {
  const std::int64_t x = std::int64_t{id.x} - area_.x, y = std::int64_t{id.y} - area_.y;
  if (x < 0 || x >= area_.width || y < firstRow_ ||
      y - firstRow_ >= static_cast<std::int64_t>(rows_.size()) || id.cell < 0 || id.cell >= side_ * side_)
    return;
  const Place place{static_cast<std::int32_t>(y), static_cast<std::int32_t>(x)};
  Pixel& pixel = at(place);
  const std::uint64_t bit = std::uint64_t{1} << id.cell;
  if ((pixel.given & bit) == 0 || (pixel.come & bit) != 0) return;
  pixel.come |= bit;

  if (side_ == 1) {
    pixel.first = color * weights_[0];
  } else if (id.cell == pixel.firstCell) {
    pixel.first = color;
  } else {
    if (!pixel.samples) pixel.samples = std::make_unique<Color[]>(weights_.size());
    pixel.samples[static_cast<std::size_t>(id.cell)] = color;
  }
  if (isWhole(pixel)) {
    if (side_ > 1) {
      const Color whole = filtered(pixel);
      pixel.samples = std::make_unique<Color[]>(1);
      pixel.samples[0] = whole;
    }
    if (pixel.full) --rowOf(place).incomplete;
  } else if (id.cell != pixel.firstCell) {
    return;  // nothing is known that was not known before
  }
  if (!refining_) return;
  while (line_.y < area_.height && decide(line_)) nextCross();
  if (guessing_) guessAround(place);
}

// Always added in the same order: the first sample, then the others by cell.
Color Sampler::filtered(const Pixel& pixel) const {
  Color sum = pixel.first * weights_[pixel.firstCell];
  for (std::size_t cell = 0; cell < weights_.size(); ++cell)
    if (cell != pixel.firstCell) sum = sum + pixel.samples[cell] * weights_[cell];
  return sum;
}

bool Sampler::takeRow(std::vector<Color>& row) {
  if (finished() || rows_.empty() || rows_.front().incomplete != 0) return false;
  // The crosses of the line below may refine this one; below the last line there are none.
  if (refining_ && line_.y <= std::min(firstRow_ + 1, area_.height - 1)) return false;
  row.clear();
  for (const Pixel& pixel : rows_.front().pixels) row.push_back(pixel.full ? wholeOf(pixel) : pixel.first);
  spare_.push_back(std::move(rows_.front().pixels));
  rows_.pop_front();
  guesses_.erase(guesses_.begin(), guesses_.lower_bound(Place{++firstRow_, 0}));
  return true;
}

Sampler::Cross Sampler::crossAt(Place c) const {
  const std::array<Place, 5> places{
      {{c.y - 1, c.x}, {c.y, c.x - 1}, {c.y, c.x}, {c.y, c.x + 1}, {c.y + 1, c.x}}};
  return {places, c.y + 1 < area_.height ? places.size() : places.size() - 1};
}

void Sampler::nextCross() {
  if (++line_.x < area_.width - 1) return;
  line_ = {changed_ ? line_.y : line_.y + 1, 1};
  changed_ = false;
}

// Applies the rule to the cross that is next.  False: a colour that it needs has not come yet.
bool Sampler::decide(Place centre) {
  if (!held(centre.y + 1)) return false;
  const Cross cross = crossAt(centre);
  const auto refinable = std::span(cross.places).first(cross.refinable);
  // Nothing can change where all are full, whatever their colours: no need to wait for them.
  if (std::ranges::all_of(refinable, [&](Place p) { return at(p).full; })) return true;

  std::array<Color, 5> colors;
  for (std::size_t i = 0; i < 5; ++i) {
    const Pixel& pixel = at(cross.places[i]);
    if (!(pixel.full ? isWhole(pixel) : hasFirst(pixel))) return false;
    colors[i] = pixel.full ? wholeOf(pixel) : pixel.first;
  }
  if (!tooMuchContrast(colors, contrast_)) return true;
  changed_ = true;
  for (const Place& place : refinable) {
    Pixel& pixel = at(place);
    if (pixel.full) continue;
    demandAll(pixel, rowOf(place));
    if (pixel.given != allCells_) demanded_.push_back(place);
  }
  return true;
}

// A colour of this pixel is new: would the crosses that it belongs to be refined by what is known now?
void Sampler::guessAround(Place place) {
  const Cross centres = crossAt(place);
  for (const Place& centre : centres.places) {
    if (centre.y < line_.y || centre.y >= area_.height || centre.x < 1 || centre.x >= area_.width - 1 ||
        !held(centre.y - 1) || !held(centre.y + 1))
      continue;
    const Cross cross = crossAt(centre);
    std::array<Color, 5> colors;
    const bool known = std::ranges::all_of(cross.places, [&, i = 0u](const Place& p) mutable {
      const Pixel& pixel = at(p);
      colors[i++] = isWhole(pixel) ? wholeOf(pixel) : pixel.first;
      return hasFirst(pixel);
    });
    if (!known || !tooMuchContrast(colors, contrast_)) continue;
    for (const Place& p : std::span(cross.places).first(cross.refinable))
      if (at(p).given != allCells_) guesses_.insert(p);
  }
}

}  // namespace rayshade
