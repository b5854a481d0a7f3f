// Cube roots and the hypotenuse.
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "rayshade/base/double_double.h"
#include "rayshade/base/elementary.h"

namespace rayshade {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

// x = 8^k m, m = 2^rest z, z in [1, 2).  First u, about m^(-1/3): a polynomial in z (through the points of Chebyshev) and
// one step of order four.  Then m u^2 is near the root; of its first 17 bits t the cube is exact, and so is m - t^3.
double elementary::cbrt(double x) {
  const double magnitude = std::abs(x);
  if (!(magnitude > 0 && magnitude < kInfinite)) [[unlikely]]
    return std::isnan(x) ? kNaN : x;
  constexpr int kBias = 1023,
                kThirds = 400;  // whole divisions round to 0: it counts from an exponent below all
  const bool subnormal = magnitude < std::numeric_limits<double>::min();
  const auto bits = std::bit_cast<std::uint64_t>(subnormal ? magnitude * 0x1p54 : magnitude);
  const int exponent = static_cast<int>(bits >> 52) - kBias + 3 * kThirds, rest = exponent % 3;
  const auto withExponent = [](std::uint64_t mantissa, int power) {
    return std::bit_cast<double>((mantissa & 0x000fffffffffffff) | static_cast<std::uint64_t>(power + kBias)
                                                                       << 52);
  };
  constexpr std::array<double, 3> kRoots = {1, 0.7937005259840998, 0.6299605249474366};  // 2^(-rest/3)
  const double z = withExponent(bits, 0), m = withExponent(bits, rest);
  const double guess = (1.66628 + z * (-1.1624 + z * (0.68465 + z * (-0.21636 + z * 0.02778)))) *
                       kRoots[static_cast<std::size_t>(rest)];
  const double error = 1 - m * guess * (guess * guess);
  const double u = guess + guess * error * (1.0 / 3 + error * (2.0 / 9 + error * (14.0 / 81))),
               squared = u * u;
  const double t = roundedTo(0x1p-16, m * squared);
  const double less = (m - t * t * t) * (u * squared);  // t^3 = m (1 - less)
  const double root = t + t * less * (1.0 / 3 + less * (2.0 / 9 + less * (14.0 / 81)));
  return std::copysign(root * withExponent(0, exponent / 3 - kThirds - (subnormal ? 18 : 0)), x);
}

// The sum of both squares with twice the bits, so that only the square root rounds, and the sum a little.
double elementary::hypot(double x, double y) {
  double a = std::abs(x), b = std::abs(y);
  if (a < b) std::swap(a, b);
  if (!(a < kInfinite && b < kInfinite)) [[unlikely]]
    return a == kInfinite || b == kInfinite ? kInfinite : kNaN;
  if (b <= a * 0x1p-54) return a + b;
  double back = 1;
  if (a > 0x1p+500 || b < 0x1p-450) [[unlikely]] {
    const double scale = a > 1 ? 0x1p-600 : 0x1p+600;
    a *= scale, b *= scale, back = 1 / scale;
  }
  const DoubleDouble first = exactProduct(a, a), second = exactProduct(b, b);
  const DoubleDouble sum = sumOfOrdered(first.high, second.high);
  return std::sqrt(sum.high + (sum.low + (first.low + second.low))) * back;
}

}  // namespace rayshade
