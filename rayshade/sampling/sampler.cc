// The sampler; what it does and why is in sampler.h.
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

namespace rayshade {
namespace {

// Pixels held below the first row that is not taken, when rows are short.
constexpr std::int32_t kPixelsAhead = 1 << 16;
constexpr std::int32_t kTilesAhead = 4;  // rows of tiles at least, however long the rows are

PixelRows rowsOf(SamplingRules rules) {
  const std::int32_t width = rules.area.width;
  return {std::move(rules), 0, width};
}

}  // namespace

Sampler::Sampler(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame, std::int32_t tileSide)
    : rows_(rowsOf(samplingRules(spec, seed, frame))),
      sweep_(rows_, rules().rowCount),
      tileSide_(tileSide),
      rowsAhead_(std::max(kTilesAhead * tileSide, kPixelsAhead / area().width)) {}

std::optional<Tile> Sampler::nextTile() {
  if (finished() || next_.y >= area().height) return std::nullopt;
  // The line below the picture goes with the last row of tiles.
  const bool last = next_.y + tileSide_ >= area().height;
  const Tile tile{next_.x, next_.y, std::min(tileSide_, area().width - next_.x),
                  last ? rules().rowCount - next_.y : tileSide_};
  if (tile.y + tile.height - rows_.first() > std::max(rowsAhead_, tile.height)) return std::nullopt;
  while (rows_.end() < tile.y + tile.height) rows_.add();
  next_.x += tile.width;
  if (next_.x == area().width) next_ = {0, next_.y + tileSide_, 0, 0};
  return tile;
}

void Sampler::supply(const Tile& tile, const TileColors& colors) {
  std::size_t pixel = 0, full = 0;
  for (std::int32_t y = tile.y; y < tile.y + tile.height; ++y) {
    if (!rows_.held(y)) break;  // the line below the picture, when all is done
    for (std::int32_t x = tile.x; x < tile.x + tile.width; ++x, ++pixel) {
      const Place place{y, x};
      if (full < colors.full.size() && colors.full[full] == pixel)
        rows_.supplyWhole(place, colors.whole[full++]);
      switch (askedOf(rules(), place)) {
        case Asked::nothing:
          continue;
        case Asked::first:
          comeInside_ += y < area().height;
          break;
        case Asked::all:
          ++comeOnBorder_;
          break;
      }
      rows_.supplyFirst(place, colors.first[pixel]);
    }
  }
  rows_.counts.given += colors.samples;
  rows_.counts.notFinite += colors.notFinite;
  sweep_.decide(rows_, demanded_);
}

std::size_t Sampler::nextSamples(std::span<SampleId> out) {
  std::size_t count = 0;
  while (count < out.size() && !demanded_.empty()) {
    const Place place = demanded_.front();
    const bool held = rows_.held(place.y);
    if (held && cell_ != firstCell(rules(), place)) out[count++] = sampleAt(rules(), place, cell_);
    if (++cell_ < rules().cells() && held) continue;
    demanded_.pop_front();
    cell_ = 0;
  }
  rows_.counts.given += count;
  return count;
}

std::size_t Sampler::missing() const {
  return demanded_.size() * static_cast<std::size_t>(rules().cells() - 1);
}

void Sampler::supply(const SampleId& id, Color color) {
  rows_.supply(id, color);
  sweep_.decide(rows_, demanded_);
}

bool Sampler::takeRow(std::vector<Color>& row) {
  const PixelArea& wanted = rules().wanted;
  while (!finished() && sweep_.isPast(rows_.first()) && rows_.takeFirst(row)) {
    if (rows_.first() <= wanted.y) continue;  // it was there to decide about others
    row.erase(row.begin() + wanted.x + wanted.width, row.end());
    row.erase(row.begin(), row.begin() + wanted.x);
    return true;
  }
  return false;
}

Completed Sampler::completed() const {
  const auto width = static_cast<std::uint64_t>(area().width),
             height = static_cast<std::uint64_t>(area().height);
  const auto cells = static_cast<std::uint64_t>(rules().cells());
  Completed done{std::max(rows_.first() - rules().wanted.y, 0), rules().wanted.height, rows_.counts.given,
                 width * height * cells};
  if (!rules().refining()) return done;
  const std::uint64_t border = pixelsAskedForAll(rules()), inside = width * height - border;
  const double onBorder = static_cast<double>(comeOnBorder_ * cells);
  const double each = comeInside_ == 0 ? static_cast<double>(cells)
                                       : std::max(static_cast<double>(done.samples) - onBorder, 0.0) /
                                             static_cast<double>(comeInside_);
  done.expected = border * cells + static_cast<std::uint64_t>(each * static_cast<double>(inside));
  return done;
}

}  // namespace rayshade
