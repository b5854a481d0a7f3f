// The arguments that the fractal textures share.
//
//   H lambda octaves       H: smoothness, 0 rough .. 1 smooth; lambda > 0: ratio of the octaves' frequencies
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/noise.h"
#include "rayshade/shapes/arguments.h"

namespace rayshade {

inline Spectrum parseSpectrum(Arguments& in) {
  const double hurst = in.number();
  const double lambda = in.number();
  if (!(lambda > 0)) in.fail("the ratio of the frequencies of a fractal must be above 0");
  return fractionalSpectrum(hurst, lambda, in.integer());
}

}  // namespace rayshade
