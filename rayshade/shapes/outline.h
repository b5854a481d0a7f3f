// The outline of a polygon of many corners, sorted so that a point can be placed inside or outside by looking at few
// edges, mostly at none.
//
// The polygon's plane is seen along the axis on which its normal is largest, and cut into level bands; each band knows
// the edges that come near it.  A grid of cells lies over it, too: to which no edge comes near, those are in or out as a whole.
// An answer is given only when the point is farther from every edge than the caller's error; so it is the answer of the exact
// test (polygon.cc), which all near misses are left to.  docs/decisions/0026-faster-rays.md
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "rayshade/optics/ray.h"

namespace rayshade {

class Outline {
 public:
  // `normal` is of length 1; the corners are finite and in one plane but for small deviations.
  Outline(const std::vector<Vec3>& corners, Vec3 normal);

  // Does the outline of these corners wind around the point where the ray meets the plane, at t?  Nothing: too close to say.
  std::optional<bool> windsAround(const std::vector<Vec3>& corners, const LocalRay& ray, double t) const;

  std::size_t bytes() const {
    return sizeof *this + (bandFirst_.capacity() + edges_.capacity()) * sizeof(std::uint32_t) +
           cells_.capacity() * sizeof(std::uint64_t);
  }

 private:
  // An edge, from its lower end up.
  struct Edge {
    double x, y, upperY;    //                                                                 [object units]
    double alongX, alongY;  // to the upper end
    int turn;               // 1 when the outline goes up along it, -1 down, 0 when it is level
    bool isPoint() const { return alongX == 0 && alongY == 0; }
  };
  Edge edge(const std::vector<Vec3>& corners, std::uint32_t number) const;  // number i begins at corner i
  std::optional<bool> windsAround(const std::vector<Vec3>& corners, double x, double y, double error) const;
  void markCells(const std::vector<Vec3>& corners);

  enum class Cell : std::uint8_t { out, in, mixed };  // mixed: an edge comes near
  Cell cell(double x, double y) const;

  Vec3 first_, normal_;
  int axisX_, axisY_;
  double deviation_ = 0, reach_ = 0;  // of the corners: from the plane, from the origin of their space
  double lowX_, highX_, lowY_, highY_;
  double overlap_ = 0, bandsPerUnit_ = 0;
  double cellsPerX_ = 0, cellsPerY_ = 0;
  std::uint32_t side_ = 0;                // of the grid, in cells
  std::vector<std::uint32_t> bandFirst_;  // of each band, and the end
  std::vector<std::uint32_t> edges_;      // band by band; an edge is in every band that it comes near
  std::vector<std::uint64_t> cells_;      // row by row, two bits each
};

}  // namespace rayshade
