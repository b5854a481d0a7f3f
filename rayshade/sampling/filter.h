// The pixel filter: how much each of the side x side samples of a pixel weighs.
//
//   box     every cell weighs the same
//   gauss   exp(-(u^2 + v^2) / 2) at the centre (u, v) of the cell, measured in pixels from the pixel's
//           centre: a standard deviation of 1 pixel whatever the width
//
// Cell a + b * side is column a, row b of the square of `width` pixels around the pixel's centre.  The total
// is 1 up to rounding.  Source: behaviour of rayshade 4.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "rayshade/base/elementary.h"
#include "rayshade/sampling/picture_spec.h"

namespace rayshade {

// That of a column of cells, or of a row, up to a factor.
inline double columnWeight(const PixelFilter& filter, std::int32_t side, std::int32_t column) {
  const double u = -filter.width / 2 + (column + 0.5) * filter.width / side;
  return filter.gaussian ? elementary::exp(-u * u / 2) : 1.0;
}

inline std::vector<double> filterWeights(const PixelFilter& filter, std::int32_t side) {
  const double cell = filter.width / side;
  std::vector<double> weights;
  double total = 0;
  for (std::int32_t b = 0; b < side; ++b) {
    for (std::int32_t a = 0; a < side; ++a) {
      const double u = -filter.width / 2 + (a + 0.5) * cell, v = -filter.width / 2 + (b + 0.5) * cell;
      const double weight = filter.gaussian ? elementary::exp(-(u * u + v * v) / 2) : 1.0;
      weights.push_back(weight);
      total += weight;
    }
  }
  // A Gaussian so wide that every weight underflows (an even side, width > 70): all are equally far away.
  for (double& weight : weights) weight = total > 0 ? weight / total : 1.0 / (side * side);
  return weights;
}

}  // namespace rayshade
