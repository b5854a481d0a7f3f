// Sine, cosine and tangent.
//
// The angle is a multiple of pi/128 plus r, |r| < 0.0123.  A table has sine and cosine of the multiple, S and C:
// sin = S cos r + C sin r = S + r + (C - 1) r + S (cos r - 1) + C (sin r - r), and with -1 in place of 1 where C < 0.
// S + r is added exactly, and where S is small, so is C - 1: the result is good to the last bit everywhere.  The cosine is the sine a quarter of a turn on.
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>

#include "rayshade/base/angle_reduction.h"
#include "rayshade/base/elementary.h"

namespace rayshade {
namespace {

constexpr unsigned kQuarter = kAngleSteps / 4;

struct Sine {
  double sine, sineLow;         // low: what the double next to it lacks
  double side, cosineLessSide;  // side: 1 or -1, the nearer one to the cosine
};

constexpr DoubleDouble sineSeries(DoubleDouble angle) {
  const DoubleDouble squared = -(angle * angle);
  DoubleDouble term = angle, sum{};
  for (int n = 1; n < 32; n += 2) {
    sum = sum + term;
    term = term * squared / DoubleDouble{static_cast<double>((n + 1) * (n + 2))};
  }
  return sum;
}

constexpr std::array<Sine, kAngleSteps> sines() {
  std::array<Sine, kAngleSteps> table{};
  for (unsigned i = 0; i <= kQuarter; ++i) {
    const DoubleDouble angle = kAngleStep * DoubleDouble{static_cast<double>(i)};
    const DoubleDouble half = sineSeries(angle * DoubleDouble{0.5});
    const DoubleDouble sine = i == kQuarter ? DoubleDouble{1} : sineSeries(angle);
    const double less = i == kQuarter ? -1 : (DoubleDouble{-2} * half * half).high;
    table[i] = {sine.high, sine.low, 1, less};
    table[2 * kQuarter - i] = {sine.high, sine.low, -1, -less};
    table[2 * kQuarter + i] = {-sine.high, -sine.low, -1, -less};
    table[(4 * kQuarter - i) % kAngleSteps] = {-sine.high, -sine.low, 1, less};
  }
  table[0] = {0, 0, 1, 0};
  return table;
}
constexpr std::array<Sine, kAngleSteps> kSines = sines();

// What sine and cosine need of the small rest of an angle.
struct Rest {
  DoubleDouble r;
  double lessThanAngle, lessThanOne;  // sin r - r, cos r - 1
};

inline Rest restOf(const ReducedAngle& angle) {
  const double r = angle.rest.high, squared = r * r;
  return {angle.rest, r * squared * (-1.0 / 6 + squared * (1.0 / 120 - squared * (1.0 / 5040))),
          squared * (-1.0 / 2 + squared * (1.0 / 24 - squared * (1.0 / 720)))};
}

// The sine of a multiple plus r, not normalised.
inline DoubleDouble sineOf(unsigned steps, const Rest& rest) {
  const Sine& s = kSines[steps % kAngleSteps];
  const DoubleDouble sum = sumOfOrdered(s.sine, s.side * rest.r.high);
  const double curved = s.sine * rest.lessThanOne + (s.side + s.cosineLessSide) * rest.lessThanAngle;
  return {sum.high,
          sum.low + ((s.sineLow + s.side * rest.r.low) + (s.cosineLessSide * rest.r.high + curved))};
}

inline double sineOf(unsigned steps, const ReducedAngle& angle) {
  const DoubleDouble sine = sineOf(steps, restOf(angle));
  return sine.high + sine.low;
}

constexpr double kTiny = 0x1p-27;  // below, the angle is its own sine and tangent

}  // namespace

double elementary::sin(double x) {
  if (std::abs(x) < kTiny) return x;
  return withReduced(x, [](const ReducedAngle& angle) { return sineOf(angle.steps, angle); });
}

double elementary::cos(double x) {
  return withReduced(x, [](const ReducedAngle& angle) { return sineOf(angle.steps + kQuarter, angle); });
}

double elementary::tan(double x) {
  if (std::abs(x) < kTiny) return x;
  return withReduced(x, [](const ReducedAngle& angle) {
    const Rest rest = restOf(angle);
    const DoubleDouble sine = sineOf(angle.steps, rest), cosine = sineOf(angle.steps + kQuarter, rest);
    const double divisor = cosine.high + cosine.low, missing = cosine.high - divisor + cosine.low;
    const double inverse = 1 / divisor, quotient = sine.high * inverse;
    const DoubleDouble product = exactProduct(quotient, divisor);
    return quotient + ((sine.high - product.high) - product.low + (sine.low - quotient * missing)) * inverse;
  });
}

}  // namespace rayshade
