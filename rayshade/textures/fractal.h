// The arguments that the fractal textures share.
//
//   H lambda octaves       H: smoothness, 0 rough .. 1 smooth; lambda: ratio of the octaves' frequencies
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/noise.h"
#include "rayshade/shapes/arguments.h"

namespace rayshade {

inline Spectrum parseSpectrum(Arguments& in) {
  const double hurst = in.number();
  const double lambda = in.number(kPositive);
  const Spectrum spectrum = fractionalSpectrum(hurst, lambda, in.integer());
  constexpr double kMostGrowth = 10;  // 64 octaves stay in the range of numbers
  if (!(spectrum.omega <= kMostGrowth))
    in.fail("each octave of this fractal is more than 10 times as strong as the one before");
  return spectrum;
}

}  // namespace rayshade
