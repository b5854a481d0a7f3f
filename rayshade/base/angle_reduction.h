// An angle as a multiple of pi/128 and a small rest.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "rayshade/base/double_double.h"

namespace rayshade {

inline constexpr int kAngleSteps = 256;  // in a whole turn
inline constexpr DoubleDouble kAngleStep = kPi / DoubleDouble{kAngleSteps / 2};

struct ReducedAngle {
  unsigned steps;  // modulo kAngleSteps
  DoubleDouble rest;
};

// Of any number from 2^-10 on, however large or near to a multiple, with all bits of the rest: slowly.
ReducedAngle reducedExactly(double angle);

// use(the reduced angle), of any number; where it is not finite, the rest is NaN.
template <class Use>
inline double withReduced(double angle, const Use& use) {
  // Two pieces whose products with whole numbers below 2^26 are exact, and the rest of the 106 bits.
  constexpr double kFirst = roundedTo(0x1p-31, kAngleStep.high);
  constexpr double kSecond = roundedTo(0x1p-57, (kAngleStep - DoubleDouble{kFirst}).high);
  constexpr double kThird = (kAngleStep - DoubleDouble{kFirst} - DoubleDouble{kSecond}).high;
  constexpr double kStepsPerRadian = 1 / kAngleStep.high, kWholeShift = 0x1.8p52, kLargest = 0x1p20;
  // Nearer to a multiple than this, too few bits of the rest would be right.
  constexpr double kNear = 0x1p-16;

  if (!(std::abs(angle) <= kLargest)) [[unlikely]]
    return use(reducedExactly(angle));
  const double shifted = angle * kStepsPerRadian + kWholeShift, whole = shifted - kWholeShift;
  // Both differences are exact: multiples of 2^-57, or of a unit of the angle if that is less, below 2^-5.
  const DoubleDouble rest = sumOfOrdered((angle - whole * kFirst) - whole * kSecond, -whole * kThird);
  if (std::abs(rest.high) < kNear && whole != 0) [[unlikely]]
    return use(reducedExactly(angle));
  return use(ReducedAngle{static_cast<unsigned>(std::bit_cast<std::uint64_t>(shifted)) % kAngleSteps, rest});
}

}  // namespace rayshade
