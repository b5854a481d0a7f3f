// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shapes/outline.h"

#include <algorithm>
#include <bit>

#include "rayshade/shapes/shape.h"

namespace rayshade {
namespace {

// How near an edge must be to count for a band, as a share of the height of the outline.
constexpr double kOverlap = 0x1p-12;
// Bounds the rounding of this test and of the exact one, together with what an error in the corner of a sheared
// triangle becomes when it is seen in the plane; generous, since it only decides who answers.
constexpr double kMargin = 8 * kRounding;
// Where products of two coordinates have lost digits: larger than 2^-1074.
constexpr double kUnderflow = 0x1p-1000;

// Edges in all bands together, per corner.
constexpr std::size_t kMostPlaces = 4;

// Cells of a row of the grid.
constexpr std::size_t kLeastSide = 8, kMostSide = 64;
constexpr std::uint32_t kPerWord = 32;

// Which of `count` equal parts of the line that begins at `low` a place is in, the ends included.
std::size_t part(double place, double low, double perUnit, std::size_t count) {
  return static_cast<std::size_t>(std::clamp((place - low) * perUnit, 0.0, static_cast<double>(count - 1)));
}

}  // namespace

Outline::Outline(const std::vector<Vec3>& corners, Vec3 normal) : first_(corners[0]), normal_(normal) {
  const int axis = dominantAxis(normal);
  axisX_ = (axis + 1) % 3;
  axisY_ = (axis + 2) % 3;
  lowX_ = lowY_ = highX_ = highY_ = 0;
  for (const Vec3& corner : corners) {
    const Vec3 from = corner - first_;
    deviation_ = std::max(deviation_, std::abs(dot(from, normal)));
    reach_ = isFinite(corner) ? std::max(reach_, maxAbs(corner)) : kInfinity;
    lowX_ = std::min(lowX_, from[axisX_]);
    highX_ = std::max(highX_, from[axisX_]);
    lowY_ = std::min(lowY_, from[axisY_]);
    highY_ = std::max(highY_, from[axisY_]);
  }
  const double height = highY_ - lowY_;
  // What came over the wire may be anything: then the exact test has all the work.
  if (!(height > 0x1p-480 && reach_ < 0x1p+480)) return;
  overlap_ = height * kOverlap;

  // As many bands as there are corners, fewer when long edges would be repeated in too many of them.
  std::size_t bands = corners.size(), places = 0;
  const auto forEachEdge = [&](auto&& use) {
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
      const Edge e = edge(corners, i);
      if (e.isPoint()) continue;
      use(i, part(e.y - 2 * overlap_, lowY_, bandsPerUnit_, bands),
          part(e.upperY + 2 * overlap_, lowY_, bandsPerUnit_, bands));
    }
  };
  for (;; bands /= 2) {
    bandsPerUnit_ = static_cast<double>(bands) / height;
    places = 0;
    forEachEdge([&](std::uint32_t, std::size_t low, std::size_t high) { places += high - low + 1; });
    if (places <= kMostPlaces * corners.size() || bands == 1) break;
  }
  bandFirst_.assign(bands + 1, 0);
  forEachEdge([&](std::uint32_t, std::size_t low, std::size_t high) {
    for (std::size_t band = low; band <= high; ++band) ++bandFirst_[band + 1];
  });
  for (std::size_t band = 0; band < bands; ++band) bandFirst_[band + 1] += bandFirst_[band];
  edges_.resize(places);
  std::vector<std::uint32_t> next(bandFirst_.begin(), bandFirst_.end() - 1);
  forEachEdge([&](std::uint32_t edge, std::size_t low, std::size_t high) {
    for (std::size_t band = low; band <= high; ++band) edges_[next[band]++] = edge;
  });
  markCells(corners);
}

Outline::Edge Outline::edge(const std::vector<Vec3>& corners, std::uint32_t number) const {
  Vec3 a = corners[number] - first_, b = corners[number + 1 < corners.size() ? number + 1 : 0] - first_;
  const int turn = a[axisY_] < b[axisY_] ? 1 : a[axisY_] > b[axisY_] ? -1 : 0;
  if (turn < 0) std::swap(a, b);
  return {a[axisX_], a[axisY_], b[axisY_], b[axisX_] - a[axisX_], b[axisY_] - a[axisY_], turn};
}

// A point whose cell is not mixed is farther than `overlap_` from every edge: it lies within that cell or, by rounding, a tiny part
// of the margin beside it, and no edge comes nearer to the cell than the margin.
void Outline::markCells(const std::vector<Vec3>& corners) {
  const double width = highX_ - lowX_, height = highY_ - lowY_;
  const double marginY = 2 * overlap_, marginX = marginY + width * kOverlap;
  if (!(width > 0)) return;
  side_ = static_cast<std::uint32_t>(std::clamp(std::bit_ceil(corners.size() / 2), kLeastSide, kMostSide));
  cellsPerX_ = side_ / width;
  cellsPerY_ = side_ / height;
  if (!(cellsPerX_ < kInfinity)) {
    side_ = 0;
    return;
  }
  std::vector<Cell> cells(std::size_t{side_} * side_, Cell::out);
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    const Edge e = edge(corners, i);
    if (e.isPoint()) continue;
    const double perY = e.alongY > 0 ? e.alongX / e.alongY : 0;
    const std::size_t last = part(e.upperY + marginY, lowY_, cellsPerY_, side_);
    for (std::size_t row = part(e.y - marginY, lowY_, cellsPerY_, side_); row <= last; ++row) {
      // What of the edge is near this row; all of it where that is not clear.
      const double below = std::max(lowY_ + static_cast<double>(row) / cellsPerY_ - marginY - e.y, 0.0);
      const double above =
          std::min(lowY_ + static_cast<double>(row + 1) / cellsPerY_ + marginY - e.y, e.alongY);
      const bool steep = e.alongY > marginY;
      const double from = steep ? below * perY : 0, to = steep ? above * perY : e.alongX;
      const std::size_t end = part(e.x + std::max(from, to) + marginX, lowX_, cellsPerX_, side_);
      for (std::size_t at = part(e.x + std::min(from, to) - marginX, lowX_, cellsPerX_, side_); at <= end;
           ++at)
        cells[row * side_ + at] = Cell::mixed;
    }
  }
  cells_.assign((cells.size() + kPerWord - 1) / kPerWord, 0);
  Cell before = Cell::mixed;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] == Cell::out) {
      // Neighbours in a row between which there is no edge are on the same side.
      if (i % side_ != 0 && before != Cell::mixed) {
        cells[i] = before;
      } else {
        const double x = lowX_ + (static_cast<double>(i % side_) + 0.5) / cellsPerX_;
        const double y = lowY_ + (static_cast<double>(i / side_) + 0.5) / cellsPerY_;
        const std::optional<bool> inside = windsAround(corners, x, y, 0);
        cells[i] = !inside ? Cell::mixed : *inside ? Cell::in : Cell::out;
      }
    }
    before = cells[i];
    cells_[i / kPerWord] |= static_cast<std::uint64_t>(cells[i]) << i % kPerWord * 2;
  }
}

Outline::Cell Outline::cell(double x, double y) const {
  if (side_ == 0) return Cell::mixed;
  const std::size_t i = part(y, lowY_, cellsPerY_, side_) * side_ + part(x, lowX_, cellsPerX_, side_);
  return static_cast<Cell>(cells_[i / kPerWord] >> i % kPerWord * 2 & 3);
}

std::optional<bool> Outline::windsAround(const std::vector<Vec3>& corners, const LocalRay& ray,
                                         double t) const {
  const double slope = std::abs(dot(normal_, ray.direction));
  const double error = (kMargin * (maxAbs(ray.origin) + reach_ + std::abs(t)) + 2 * deviation_) / slope;
  if (!(error < overlap_)) return std::nullopt;
  const double x = ray.origin[axisX_] + t * ray.direction[axisX_] - first_[axisX_];
  const double y = ray.origin[axisY_] + t * ray.direction[axisY_] - first_[axisY_];
  if (x < lowX_ - error || x > highX_ + error || y < lowY_ - error || y > highY_ + error) return false;
  const Cell here = cell(x, y);
  if (here != Cell::mixed) return here == Cell::in;
  return windsAround(corners, x, y, error);
}

std::optional<bool> Outline::windsAround(const std::vector<Vec3>& corners, double x, double y,
                                         double error) const {
  const std::size_t band = part(y, lowY_, bandsPerUnit_, bandFirst_.size() - 1);
  int winding = 0;
  for (std::uint32_t i = bandFirst_[band]; i < bandFirst_[band + 1]; ++i) {
    const Edge e = edge(corners, edges_[i]);
    const double side = e.alongX * (y - e.y) - e.alongY * (x - e.x);  // > 0: left of it, going up
    if (!(std::abs(side) > error * (std::abs(e.alongX) + e.alongY) + kUnderflow)) return std::nullopt;
    if (e.y <= y && y < e.upperY && side > 0) winding += e.turn;
  }
  return winding != 0;
}

}  // namespace rayshade
