// Numbers of about 106 bits: the exact sum of two doubles, of which the second is at most half a unit in the last place
// of the first.
//
// Only + - * and / of doubles, so the bits are the same on every processor, and constants can be computed when this is
// compiled.  Products are exact as long as nothing overflows and nothing falls below 2^-969.
//
// Sources: Dekker, A floating-point technique for extending the available precision, Numer. Math. 18, 1971; Knuth, The
// Art of Computer Programming 2, section 4.2.2.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>

namespace rayshade {

struct DoubleDouble {
  double high = 0, low = 0;
};

// a + b, exactly, if a is 0 or its exponent is not below that of b.
constexpr DoubleDouble sumOfOrdered(double a, double b) {
  const double sum = a + b;
  return {sum, (a - sum) + b};
}

// a + b, exactly.
constexpr DoubleDouble exactSum(double a, double b) {
  const double sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

// x without its last 27 bits, so that the product of two such numbers is exact.
constexpr double upperBits(double x) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & ~std::uint64_t{0x7ffffff});
}

// a b, exactly but for a unit in the 106th place.
constexpr DoubleDouble exactProduct(double a, double b) {
  const double product = a * b, aHigh = upperBits(a), bHigh = upperBits(b), aLow = a - aHigh,
               bLow = b - bHigh;
  return {product, ((aHigh * bHigh - product) + aHigh * bLow + aLow * bHigh) + aLow * bLow};
}

// The multiple of `unit`, a power of two, that is nearest to x; |x| below 2^51 units.
constexpr double roundedTo(double unit, double x) {
  const double shift = 0x1.8p52 * unit;
  return (x + shift) - shift;
}

constexpr DoubleDouble operator-(DoubleDouble a) { return {-a.high, -a.low}; }
// These four are wrong by a few units in the 104th place; in sums, of the larger part.
constexpr DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble sum = exactSum(a.high, b.high);
  return sumOfOrdered(sum.high, sum.low + (a.low + b.low));
}
constexpr DoubleDouble operator-(DoubleDouble a, DoubleDouble b) { return a + -b; }
constexpr DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble product = exactProduct(a.high, b.high);
  return sumOfOrdered(product.high, product.low + (a.high * b.low + a.low * b.high));
}
constexpr DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
  const double quotient = a.high / b.high;
  const DoubleDouble product = exactProduct(quotient, b.high);
  return sumOfOrdered(quotient,
                      ((a.high - product.high) - product.low + (a.low - quotient * b.low)) / b.high);
}

// The square root of a number near 1 (by Newton's steps from 1).
constexpr DoubleDouble squareRootNearOne(DoubleDouble x) {
  DoubleDouble root{1};
  for (int step = 0; step < 6; ++step) root = (root + x / root) * DoubleDouble{0.5};
  return root;
}

// Of these each is the double next to the number, and the double next to what is missing.
inline constexpr DoubleDouble kPi{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
inline constexpr DoubleDouble kLn2{0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};

}  // namespace rayshade
