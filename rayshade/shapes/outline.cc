// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shapes/outline.h"

#include <algorithm>

#include "rayshade/base/elementary.h"
#include "rayshade/shapes/shape.h"

namespace rayshade {
namespace {

// How near an edge must be to count for a band, as a share of the height of the outline.
constexpr double kOverlap = 0x1p-12;
// Bounds the rounding of this test and of the exact one, together with what an error in the corner of a sheared
// triangle becomes when it is seen in the plane; generous, since it only decides who answers.
constexpr double kMargin = 8 * kRounding;

// Edges in all bands together, per corner.
constexpr std::size_t kMostPlaces = 4;

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
  const auto bandOf = [&](double y) {
    return static_cast<std::size_t>(
        std::clamp((y - lowY_) * bandsPerUnit_, 0.0, static_cast<double>(bands - 1)));
  };
  const auto forEachEdge = [&](auto&& use) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      Vec3 a = corners[i] - first_, b = corners[i + 1 < corners.size() ? i + 1 : 0] - first_;
      const int turn = a[axisY_] < b[axisY_] ? 1 : a[axisY_] > b[axisY_] ? -1 : 0;
      if (turn < 0) std::swap(a, b);
      const double x = b[axisX_] - a[axisX_], y = b[axisY_] - a[axisY_], size = elementary::hypot(x, y);
      if (!(size > 0)) continue;
      use(Edge{a[axisX_], a[axisY_], b[axisY_], x / size, y / size, turn}, bandOf(a[axisY_] - 2 * overlap_),
          bandOf(b[axisY_] + 2 * overlap_));
    }
  };
  for (;; bands /= 2) {
    bandsPerUnit_ = static_cast<double>(bands) / height;
    places = 0;
    forEachEdge([&](const Edge&, std::size_t low, std::size_t high) { places += high - low + 1; });
    if (places <= kMostPlaces * corners.size() || bands == 1) break;
  }
  bandFirst_.assign(bands + 1, 0);
  forEachEdge([&](const Edge&, std::size_t low, std::size_t high) {
    for (std::size_t band = low; band <= high; ++band) ++bandFirst_[band + 1];
  });
  for (std::size_t band = 0; band < bands; ++band) bandFirst_[band + 1] += bandFirst_[band];
  edges_.resize(places);
  std::vector<std::uint32_t> next(bandFirst_.begin(), bandFirst_.end() - 1);
  forEachEdge([&](const Edge& edge, std::size_t low, std::size_t high) {
    for (std::size_t band = low; band <= high; ++band) edges_[next[band]++] = edge;
  });
}

std::optional<bool> Outline::windsAround(const LocalRay& ray, double t) const {
  const double slope = std::abs(dot(normal_, ray.direction));
  const double error = (kMargin * (maxAbs(ray.origin) + reach_ + std::abs(t)) + 2 * deviation_) / slope;
  if (!(error < overlap_)) return std::nullopt;
  const double x = ray.origin[axisX_] + t * ray.direction[axisX_] - first_[axisX_];
  const double y = ray.origin[axisY_] + t * ray.direction[axisY_] - first_[axisY_];
  if (x < lowX_ - error || x > highX_ + error || y < lowY_ - error || y > highY_ + error) return false;
  const auto last = static_cast<double>(bandFirst_.size() - 2);
  const auto band = static_cast<std::size_t>(std::clamp((y - lowY_) * bandsPerUnit_, 0.0, last));
  int winding = 0;
  for (std::uint32_t i = bandFirst_[band]; i < bandFirst_[band + 1]; ++i) {
    const Edge& edge = edges_[i];
    const double side = edge.alongX * (y - edge.y) - edge.alongY * (x - edge.x);  // > 0: left of it, going up
    if (std::abs(side) <= error) return std::nullopt;
    if (edge.y <= y && y < edge.upperY && side > 0) winding += edge.turn;
  }
  return winding != 0;
}

}  // namespace rayshade
