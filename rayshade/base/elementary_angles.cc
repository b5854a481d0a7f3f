// Arc sine, arc cosine and arc tangent.
//
// Both functions are expanded around multiples c of 1/128: f(c + h) = f(c) + h + (slope - 1) h + ..., |h| <= 1/256.  Their
// first two terms are added exactly.  The derivative of both is (1 + s x^2)^-p, s = 1 and p = 1 for the arc tangent, s = -1
// and p = 1/2 for the arc sine; its coefficients g around c follow from (1 + s x^2) g' = -2 p s x g:
//   (k + 1)(1 + s c^2) g[k + 1] = -s (2 c (k + p) g[k] + (k - 1 + 2 p) g[k - 1])
// What is outside of the tables goes through pi/2 - atan(1/x), and asin(x) = pi/2 - 2 asin(sqrt((1 - x)/2)).
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <limits>

#include "rayshade/base/double_double.h"
#include "rayshade/base/elementary.h"

namespace rayshade {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kPerUnit = 128;
constexpr DoubleDouble kHalfPi{kPi.high / 2, kPi.low / 2};

struct Expansion {
  DoubleDouble value;              // of the function at c
  double slope;                    // less 1
  std::array<double, 7> higher{};  // of h^2 to h^8
};

// At the multiples 0, 1, ... of 1/128; each value comes from the expansion before it.
template <std::size_t size>
constexpr std::array<Expansion, size> expansions(double s, double p) {
  constexpr int kTerms = 18;
  std::array<Expansion, size> table{};
  DoubleDouble value{};
  for (std::size_t i = 0; i < size; ++i) {
    const double c = static_cast<double>(i) / kPerUnit;
    const DoubleDouble width{1 + s * c * c};
    std::array<DoubleDouble, kTerms> g{};
    g[0] = DoubleDouble{1} / (p == 1 ? width : squareRootNearOne(width));
    for (int k = 0; k + 1 < kTerms; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const DoubleDouble before = k == 0 ? DoubleDouble{} : DoubleDouble{k - 1 + 2 * p} * g[at - 1];
      g[at + 1] = DoubleDouble{-s} * (DoubleDouble{2 * c * (k + p)} * g[at] + before) /
                  (DoubleDouble{k + 1.0} * width);
    }
    table[i].value = value;
    table[i].slope = (g[0] - DoubleDouble{1}).high;
    for (std::size_t k = 0; k < table[i].higher.size(); ++k)
      table[i].higher[k] = (g[k + 1] / DoubleDouble{static_cast<double>(k + 2)}).high;
    DoubleDouble power{1 / kPerUnit};
    for (int k = 0; k < kTerms; ++k) {
      value = value + power * g[static_cast<std::size_t>(k)] / DoubleDouble{k + 1.0};
      power = power * DoubleDouble{1 / kPerUnit};
    }
  }
  return table;
}
constexpr auto kArcTangents = expansions<129>(1, 1);
constexpr auto kArcSines = expansions<65>(-1, 0.5);

// f(x + low), not normalised; x is within the table, low far below it.
template <std::size_t size>
inline DoubleDouble valueAt(const std::array<Expansion, size>& table, double x, double low) {
  const double shifted = x * kPerUnit + 0x1.8p52, whole = shifted - 0x1.8p52;
  const Expansion& e = table[static_cast<std::size_t>(std::bit_cast<std::uint64_t>(shifted) & 0xff)];
  const double h = x - whole / kPerUnit;  // exact
  const auto& a = e.higher;
  const double squared = h * h;
  const double curved =
      squared *
      ((a[0] + h * a[1]) + squared * ((a[2] + h * a[3]) + squared * ((a[4] + h * a[5]) + squared * a[6])));
  const DoubleDouble sum = sumOfOrdered(e.value.high, h);
  return {sum.high, sum.low + (e.value.low + (e.slope * (h + low) + (low + curved)))};
}

// a - b for an a not below b, not normalised.
inline DoubleDouble difference(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble sum = sumOfOrdered(a.high, -b.high);
  return {sum.high, sum.low + (a.low - b.low)};
}
inline double rounded(DoubleDouble a) { return a.high + a.low; }

// The arc sine of x in [0, 1/2].
inline DoubleDouble arcSine(double x) { return valueAt(kArcSines, x, 0); }
// The arc cosine of x in [1/2, 1].
inline DoubleDouble arcCosineNearOne(double x) {
  const double half = (1 - x) * 0.5;  // exact
  if (half == 0) return {};
  const double root = std::sqrt(half);
  const DoubleDouble square = exactProduct(root, root);
  // What the root lacks, (half - root^2) / (2 root), with a division that need not wait for the root.
  const double lacking = ((half - square.high) - square.low) * (root * (1 / (1 - x)));
  const DoubleDouble angle = valueAt(kArcSines, root, lacking);
  return {2 * angle.high, 2 * angle.low};
}

// The arc tangents of 1/x for x > 1, and of small/large in [0, 1]; no product or quotient leaves the normal numbers.
inline DoubleDouble arcTangentOfInverse(double x) {
  const double inverse = 1 / x;
  const DoubleDouble product = exactProduct(inverse, x);
  return valueAt(kArcTangents, inverse, ((1 - product.high) - product.low) * inverse);
}
inline DoubleDouble arcTangentOfQuotient(double small, double large) {
  const double quotient = small / large;
  const DoubleDouble product = exactProduct(quotient, large);
  return valueAt(kArcTangents, quotient, ((small - product.high) - product.low) / large);
}

constexpr double kTiny = 0x1p-27;  // below, x is its own arc sine and arc tangent

}  // namespace

double elementary::asin(double x) {
  const double magnitude = std::abs(x);
  if (magnitude < kTiny) return x;
  if (!(magnitude <= 1)) [[unlikely]]
    return kNaN;
  const double angle =
      rounded(magnitude <= 0.5 ? arcSine(magnitude) : difference(kHalfPi, arcCosineNearOne(magnitude)));
  return std::copysign(angle, x);
}

double elementary::acos(double x) {
  const double magnitude = std::abs(x);
  if (!(magnitude <= 1)) [[unlikely]]
    return kNaN;
  if (magnitude <= 0.5) {
    const DoubleDouble angle = arcSine(magnitude);
    return rounded(difference(kHalfPi, x < 0 ? -angle : angle));
  }
  const DoubleDouble angle = arcCosineNearOne(magnitude);
  return rounded(x < 0 ? difference(kPi, angle) : angle);
}

double elementary::atan(double x) {
  const double magnitude = std::abs(x);
  if (magnitude < kTiny) return x;
  if (std::isnan(x)) [[unlikely]]
    return kNaN;
  if (magnitude > 0x1p54) return std::copysign(kHalfPi.high, x);
  return std::copysign(rounded(magnitude <= 1 ? valueAt(kArcTangents, magnitude, 0)
                                              : difference(kHalfPi, arcTangentOfInverse(magnitude))),
                       x);
}

double elementary::atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) [[unlikely]]
    return kNaN;
  double a = std::abs(y), b = std::abs(x);
  const bool steep = a > b, left = std::signbit(x);
  if (std::isinf(a) || std::isinf(b)) [[unlikely]] {
    a = std::isinf(a) ? 1 : 0, b = std::isinf(b) ? 1 : 0;
  }
  const double small = steep ? b : a, large = steep ? a : b;
  DoubleDouble angle{};  // from the nearer axis
  if (small != 0) {
    // Scaled, so that nothing leaves the normal numbers.
    const double scale = large > 0x1p500 ? 0x1p-600 : large < 0x1p-400 ? 0x1p600 : 1;
    const double smaller = small * scale, larger = large * scale;
    if (smaller < larger * 0x1p-60) {
      if (!steep && !left) return std::copysign(small / large, y);
      angle = {smaller / larger};
    } else {
      angle = arcTangentOfQuotient(smaller, larger);
    }
  }
  if (steep)
    angle = difference(kHalfPi, left ? -angle : angle);
  else if (left)
    angle = difference(kPi, angle);
  return std::copysign(rounded(angle), y);
}

}  // namespace rayshade
