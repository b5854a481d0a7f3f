// Exponentials, logarithms, powers and roots.
//
// e^x: x = k (ln 2)/512 + r, so e^x = 2^(k/512) e^r: a table, and the series for |r| < 0.0007.
// log x: x = 2^k z with z in [0.6875, 1.375).  A table has a number c of few bits near 1/z, so that r = z c - 1 is exact
// and below 1/256; log x = k ln 2 - log c + log(1 + r).  As a DoubleDouble its error is below 2^-68 of it, so that x^y =
// e^(y log x) is good to the last bit, too.
// The tables are computed when this is compiled.  Series are those of Taylor, broken off where what is left is less than a
// hundredth of a unit in the last place.
//
// Source of such tables: Tang, Table-driven implementation of the exponential function, ACM TOMS 15, 1989, and of the
// logarithm function, 16, 1990.
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <limits>

#include "rayshade/base/double_double.h"
#include "rayshade/base/elementary.h"

namespace rayshade {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kMantissa = 0x000fffffffffffff;
constexpr int kMantissaBits = 52;

std::uint64_t bitsOf(double x) { return std::bit_cast<std::uint64_t>(x); }

// ---- e^x

constexpr int kSteps = 512, kStepBits = 9;  // from one power of two to the next

struct Power {
  std::uint64_t bits;  // of the double next to 2^(i/kSteps)
  double low;          // what is missing, as a part of it
};

constexpr std::array<Power, kSteps> powersOfTwo() {
  const DoubleDouble step = kLn2 / DoubleDouble{kSteps};
  DoubleDouble factor{1}, term{1};  // the series of e^step
  for (int n = 1; n < 16; ++n) {
    term = term * step / DoubleDouble{static_cast<double>(n)};
    factor = factor + term;
  }
  std::array<Power, kSteps> table{};
  DoubleDouble power{1};
  for (Power& entry : table) {
    entry = {std::bit_cast<std::uint64_t>(power.high), power.low / power.high};
    power = power * factor;
  }
  return table;
}
constexpr std::array<Power, kSteps> kPowers = powersOfTwo();

// The first part has so few bits that its products with whole numbers below 2^20 are exact.
constexpr DoubleDouble kStep = kLn2 / DoubleDouble{kSteps};
constexpr double kStepHigh = roundedTo(0x1p-42, kStep.high),
                 kStepLow = (kStep - DoubleDouble{kStepHigh}).high;
constexpr double kStepsPerUnit = kSteps / kLn2.high;
constexpr double kWholeShift = 0x1.8p52;  // x + this has no bits behind the point

// x = steps (ln 2)/kSteps + rest
struct ReducedExponent {
  std::int64_t steps;
  DoubleDouble rest;
};

// |x| below 2000.
inline ReducedExponent reducedExponent(double x) {
  const double shifted = x * kStepsPerUnit + kWholeShift, whole = shifted - kWholeShift;
  const auto steps = static_cast<std::int64_t>(bitsOf(shifted) << 12) >> 12;
  const double first = x - whole * kStepHigh, second = whole * kStepLow, rest = first - second;
  return {steps, {rest, (first - rest) - second}};
}

// e^r - 1 - r
inline double exponentialTail(double r) {
  const double squared = r * r;
  return squared * ((1.0 / 2 + r * (1.0 / 6)) + squared * (1.0 / 24));
}

double timesPowerOfTwo(std::uint64_t bits, std::int64_t exponent) {
  return std::bit_cast<double>(bits + (static_cast<std::uint64_t>(exponent) << kMantissaBits));
}

// 2^(steps/kSteps) e^r, a normal number.
inline double exponentialOf(std::int64_t steps, double r) {
  const Power& power = kPowers[static_cast<std::size_t>(steps & (kSteps - 1))];
  const double scale = timesPowerOfTwo(power.bits, steps >> kStepBits);
  return scale + scale * (r + (power.low + exponentialTail(r)));
}

constexpr double kLargestNormal = 708;  // of exponents: e^x and e^-x are normal numbers

// e^(x + low) for all others.
double exponentialOfLarge(double x, double low) {
  if (!(std::abs(x) < 2000)) return x > 0 ? kInfinite : x < 0 ? 0 : kNaN;
  const ReducedExponent e = reducedExponent(x);
  // Rounded again only where units in the last place are at least twice as large.
  return std::ldexp(exponentialOf(e.steps & (kSteps - 1), e.rest.high + low),
                    static_cast<int>(e.steps >> kStepBits));
}

// ---- log x

constexpr int kIntervals = 256;
constexpr std::uint64_t kLowest = std::bit_cast<std::uint64_t>(0.6875);  // of z

struct Interval {
  double inverse;  // c: a multiple of 1/512
  double high;     // -log c, in multiples of 2^-42,
  double low;      // and the rest
};

constexpr DoubleDouble logarithmOfRatio(double a, double b) {  // log(a/b) = 2 artanh((a - b)/(a + b))
  const DoubleDouble t = DoubleDouble{a - b} / DoubleDouble{a + b}, squared = t * t;
  DoubleDouble power = t, sum{};
  for (int n = 1; n < 45; n += 2) {
    sum = sum + power / DoubleDouble{static_cast<double>(n)};
    power = power * squared;
  }
  return sum + sum;
}

constexpr std::array<Interval, kIntervals> logarithms() {
  std::array<Interval, kIntervals> table{};
  for (std::uint64_t i = 0; i < kIntervals; ++i) {
    const auto edge = [](std::uint64_t of) {
      return std::bit_cast<double>(kLowest + (of << (kMantissaBits - 8)));
    };
    double inverse = roundedTo(0x1p-9, 2 / (edge(i) + edge(i + 1)));
    // Next to 1 the logarithm is r alone, so nothing of it cancels.
    if (edge(i) == 1 || edge(i + 1) == 1) inverse = 1;
    const DoubleDouble logarithm = logarithmOfRatio(1, inverse);
    const double high = roundedTo(0x1p-42, logarithm.high);
    table[i] = {inverse, high, (logarithm - DoubleDouble{high}).high};
  }
  return table;
}
constexpr std::array<Interval, kIntervals> kLogarithms = logarithms();
constexpr double kLn2High = roundedTo(0x1p-42, kLn2.high), kLn2Low = (kLn2 - DoubleDouble{kLn2High}).high;

// The leading terms of a logarithm: exponent ln 2 - log c + r = leading + low.
struct Logarithm {
  DoubleDouble r, leading;  // exact
  double low;
};

// Of a positive finite number.
inline Logarithm leadingLogarithm(double x) {
  std::uint64_t bits = bitsOf(x);
  double exponent = 0;
  if (bits <= kMantissa) [[unlikely]] {
    bits = bitsOf(x * 0x1p52);
    exponent = -52;
  }
  const std::uint64_t offset = bits - kLowest;
  exponent +=
      static_cast<double>(static_cast<std::int32_t>(static_cast<std::int64_t>(offset) >> kMantissaBits));
  const double z = std::bit_cast<double>(bits - (offset & ~kMantissa));
  const Interval& interval = kLogarithms[(offset >> (kMantissaBits - 8)) & (kIntervals - 1)];
  // Of z's two halves both products are exact.
  const double zHigh = upperBits(z);
  const DoubleDouble r = sumOfOrdered(zHigh * interval.inverse - 1, (z - zHigh) * interval.inverse);
  return {r, sumOfOrdered(exponent * kLn2High + interval.high, r.high), exponent * kLn2Low + interval.low};
}

// Not normalised: |low| is below 2^-8 |high|.
inline DoubleDouble logarithmOf(double x) {
  const Logarithm l = leadingLogarithm(x);
  const double r = l.r.high, squared = r * r;
  // r^2/2, with what its rounding loses.
  const double rHigh = upperBits(r), lost = (rHigh * rHigh - squared) + (r - rHigh) * (rHigh + r);
  const DoubleDouble sum = sumOfOrdered(l.leading.high, -0.5 * squared);
  const double cubic =
      r * squared *
      ((1.0 / 3 - r * (1.0 / 4)) +
       squared * ((1.0 / 5 - r * (1.0 / 6)) + squared * ((1.0 / 7 - r * (1.0 / 8)) + squared * (1.0 / 9))));
  const double low = (l.leading.low + sum.low) + l.low + ((l.r.low - r * l.r.low) - 0.5 * lost);
  return {sum.high, low + cubic};
}

// ---- powers

enum class Parity { fraction, even, odd };

Parity parityOf(double y) {
  const double magnitude = std::abs(y);
  if (magnitude >= 0x1p53) return Parity::even;
  if (magnitude != std::trunc(magnitude)) return Parity::fraction;
  return static_cast<std::int64_t>(magnitude) % 2 == 0 ? Parity::even : Parity::odd;
}

// Where x or y is zero, infinite or NaN, or x negative: annex F.9.4.4.
double specialPower(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (std::isnan(x) || std::isnan(y)) return kNaN;
  const double magnitude = std::abs(x);
  if (std::isinf(y)) {
    if (magnitude == 1) return 1;
    return (magnitude > 1) == (y > 0) ? kInfinite : 0;
  }
  const Parity parity = parityOf(y);
  if (magnitude != 0 && !std::isinf(x) && parity == Parity::fraction) return kNaN;
  const double result = magnitude == 0 || std::isinf(x) ? ((magnitude == 0) == (y > 0) ? 0 : kInfinite)
                                                        : elementary::pow(magnitude, y);
  return std::signbit(x) && parity == Parity::odd ? -result : result;
}

}  // namespace

double elementary::exp(double x) {
  if (!(std::abs(x) < kLargestNormal)) [[unlikely]]
    return exponentialOfLarge(x, 0);
  const ReducedExponent e = reducedExponent(x);
  return exponentialOf(e.steps, e.rest.high);
}

double elementary::expm1(double x) {
  if (std::abs(x) < 0x1p-54) return x;
  if (!(std::abs(x) < 40)) return x < 0 ? -1 : exp(x);  // 1 is less than half a unit in the last place of e^x
  const ReducedExponent e = reducedExponent(x);
  const Power& power = kPowers[static_cast<std::size_t>(e.steps & (kSteps - 1))];
  const double scale = timesPowerOfTwo(power.bits, e.steps >> kStepBits), r = e.rest.high;
  // scale (1 + r + tail) - 1 = (scale - 1) + r + (scale - 1) r + scale tail; the first sum is exact.
  // One term more of the series than the others need.
  const double tail = e.rest.low + power.low + exponentialTail(r) + r * (r * r) * (r * r) * (1.0 / 120);
  const DoubleDouble less = exactSum(scale, -1), sum = exactSum(less.high, r);
  return sum.high + (sum.low + (less.low + (less.high * r + scale * tail)));
}

double elementary::log(double x) {
  if (!(x > 0 && x < kInfinite)) [[unlikely]]
    return x == 0 ? -kInfinite : x > 0 ? x : kNaN;
  const Logarithm l = leadingLogarithm(x);
  const double r = l.r.high, squared = r * r;
  const double curved =
      squared * ((r * (1.0 / 3) - 1.0 / 2) +
                 squared * ((r * (1.0 / 5) - 1.0 / 4) + squared * (r * (1.0 / 7) - 1.0 / 6)));
  return l.leading.high + (l.leading.low + (l.r.low + (l.low + curved)));
}

double elementary::pow(double x, double y) {
  if (!(x > 0 && x < kInfinite && std::abs(y) < kInfinite)) [[unlikely]]
    return specialPower(x, y);
  const DoubleDouble unordered = logarithmOf(x), logarithm = sumOfOrdered(unordered.high, unordered.low);
  const double yHigh = upperBits(y), yLow = y - yHigh, high = upperBits(logarithm.high),
               low = logarithm.high - high + logarithm.low;
  const DoubleDouble exponent = sumOfOrdered(yHigh * high, yLow * high + y * low);
  if (!(std::abs(exponent.high) < kLargestNormal)) [[unlikely]]
    // Where the products overflow, the power is far outside of what there is; that of 1 is 1.
    return std::abs(y) < 0x1p65              ? exponentialOfLarge(exponent.high, exponent.low)
           : logarithm.high == 0             ? 1
           : (logarithm.high > 0) == (y > 0) ? kInfinite
                                             : 0;
  const ReducedExponent e = reducedExponent(exponent.high);
  return exponentialOf(e.steps, e.rest.high + exponent.low);
}

}  // namespace rayshade
