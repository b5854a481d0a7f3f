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
#include <bit>

namespace rayshade {
namespace {

constexpr std::int32_t kBlock = 8;  // pixels: the side of a block of first samples
// Pixels held below the first row that is not taken, when rows are short.
constexpr std::int32_t kPixelsAhead = 1 << 14;
constexpr std::int32_t kRowsAhead = 3 * kBlock;  // at least, however long the rows are

}  // namespace

Sampler::Sampler(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame, Guessing guessing)
    : rows_(samplingRules(spec, seed, frame)),
      guessing_(guessing == Guessing::yes),
      rowsAhead_(std::max(kRowsAhead, kPixelsAhead / area().width)) {}

std::size_t Sampler::next(std::span<SampleId> out) {
  std::size_t count = 0;
  while (count < out.size() && give(out[count])) ++count;
  rows_.counts.given += count;
  return count;
}

// The first cell of a pixel that has not been given yet.
inline bool Sampler::giveCell(Pixel& pixel, Place place, SampleId& out) {
  if (pixel.given == rows_.rules().allCells) return false;
  const int cell = std::countr_one(pixel.given);
  pixel.given |= std::uint64_t{1} << cell;
  out = {area().x + place.x, area().y + place.y, cell};
  return true;
}

bool Sampler::give(SampleId& out) {
  if (finished()) return false;
  if (!demanded_.empty()) {
    const Place place = demanded_.front();
    Pixel& pixel = rows_.at(place);
    giveCell(pixel, place, out);
    if (pixel.given == rows_.rules().allCells) demanded_.pop_front();
    return true;
  }
  if (giveAhead(out)) return true;
  for (; !guesses_.empty(); guesses_.erase(guesses_.begin()))
    if (giveCell(rows_.at(*guesses_.begin()), *guesses_.begin(), out)) return true;
  return false;
}

Completed Sampler::completed() const {
  const auto width = static_cast<std::uint64_t>(area().width),
             height = static_cast<std::uint64_t>(area().height);
  const SamplingRules& rules = rows_.rules();
  const auto cells = static_cast<std::uint64_t>(rules.side) * static_cast<std::uint64_t>(rules.side);
  Completed done{rows_.first(), area().height, rows_.counts.given, width * height * cells};
  if (!rules.refining) return done;
  const std::uint64_t inside = (width - 2) * (height - 2), border = width * height - inside;
  const double onBorder = static_cast<double>(begunOnBorder_ * cells);
  const double each = begunInside_ == 0 ? static_cast<double>(cells)
                                        : std::max(static_cast<double>(done.samples) - onBorder, 0.0) /
                                              static_cast<double>(begunInside_);
  done.expected = border * cells + static_cast<std::uint64_t>(each * static_cast<double>(inside));
  return done;
}

// All samples of a pixel of the border, the first of any other, band by band and block by block.
bool Sampler::giveAhead(SampleId& out) {
  const SamplingRules& rules = rows_.rules();
  bool found = false;
  while (!found && ahead_.y < rules.rowCount) {
    if (!rows_.held(ahead_.y)) {
      if (ahead_.y - rows_.first() >= rowsAhead_) return false;
      const std::int32_t bandEnd = std::min(rows_.end() + kBlock, rules.rowCount);
      while (rows_.end() < bandEnd) rows_.add();
    }
    const Place place = ahead_;
    Pixel& pixel = rows_.at(place);
    const bool idle = place.y == area().height && (place.x == 0 || place.x == area().width - 1);
    if (pixel.full) {
      found = giveCell(pixel, place, out);
    } else if (!idle) {
      found = true;
      pixel.given = pixel.firstBit();
      out = {area().x + place.x, area().y + place.y, pixel.firstCell};
    }
    if (!pixel.full || pixel.given == rules.allCells) stepAhead();
  }
  return found;
}

void Sampler::stepAhead() {
  const std::int32_t width = area().width;
  const std::int32_t last = area().height - 1;
  const bool onBorder = ahead_.x == 0 || ahead_.x == width - 1 || ahead_.y == 0 || ahead_.y == last;
  if (ahead_.y <= last) ++(onBorder ? begunOnBorder_ : begunInside_);
  const std::int32_t band = ahead_.y / kBlock * kBlock,
                     bandEnd = std::min(band + kBlock, rows_.rules().rowCount);
  const std::int32_t block = ahead_.x / kBlock * kBlock, blockEnd = std::min(block + kBlock, width);
  if (++ahead_.x < blockEnd) return;
  ahead_.x = block;
  if (++ahead_.y < bandEnd) return;
  ahead_ = blockEnd < width ? Place{band, blockEnd} : Place{bandEnd, 0};
}

void Sampler::supply(const SampleId& id, Color color) {
  const std::optional<Place> place = rows_.supply(id, color);
  if (!place || !rows_.rules().refining) return;
  sweep_.decide(rows_, demanded_);
  if (guessing_) sweep_.guess(rows_, *place, guesses_);
}

bool Sampler::takeRow(std::vector<Color>& row) {
  if (finished() || (rows_.rules().refining && !sweep_.isPast(rows_.first(), rows_))) return false;
  if (!rows_.takeFirst(row)) return false;
  guesses_.erase(guesses_.begin(), guesses_.lower_bound(Place{rows_.first(), 0}));
  return true;
}

}  // namespace rayshade
