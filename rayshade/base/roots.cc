// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/roots.h"

#include <algorithm>
#include <cmath>

namespace rayshade {
namespace {

template <std::size_t N>
using Coefficients = std::array<double, N>;  // of degree N - 1

constexpr double kUnit = 0x1p-53;           // largest relative error of one operation
constexpr double kZeroAtTurn = 16 * kUnit;  // coefficients come out of about this many operations

struct Value {
  double value, slope;
  double size;  // sum of |c[i] x^i|: what the rounding errors are relative to
};

template <std::size_t N>
Value valueAt(const Coefficients<N>& c, double x) {
  Value v{c[N - 1], 0, std::abs(c[N - 1])};
  for (std::size_t i = N - 1; i-- > 0;) {
    v.slope = v.slope * x + v.value;
    v.value = v.value * x + c[i];
    v.size = v.size * std::abs(x) + std::abs(c[i]);
  }
  return v;
}

// The root in (a, b), where the value is below zero on exactly one side.
template <std::size_t N>
double closeIn(const Coefficients<N>& c, double a, double b, bool negativeAtA) {
  double x = a + (b - a) / 2, step = b - a;
  // Every turn halves the bracket or the Newton step, so this ends long before the 128th.
  for (int turn = 0; turn < 128; ++turn) {
    const Value v = valueAt(c, x);
    if (std::abs(v.value) <= kUnit / 2 * v.size) return x;
    ((v.value < 0) == negativeAtA ? a : b) = x;
    double next = x - v.value / v.slope;
    if (!(next > a && next < b && std::abs(next - x) <= std::abs(step) / 2)) next = a + (b - a) / 2;
    step = next - x;
    if (std::abs(step) <= kUnit * std::abs(x) || next == a || next == b) return next;
    x = next;
  }
  return x;
}

Roots find(const Coefficients<3>& c, double low, double high) {
  Roots roots;
  const double discriminant = c[1] * c[1] - 4 * c[2] * c[0];
  if (!(discriminant >= 0)) return roots;
  const double q = -0.5 * (c[1] + std::copysign(std::sqrt(discriminant), c[1]));
  double first = q / c[2], second = c[0] / q;  // a root at infinity or 0/0 fails the comparisons below
  if (first > second) std::swap(first, second);
  if (first >= low && first <= high) roots.add(first);
  if (second >= low && second <= high && second != first) roots.add(second);
  return roots;
}

template <std::size_t N>
Roots find(const Coefficients<N>& c, double low, double high) {
  Coefficients<N - 1> derivative;
  for (std::size_t i = 1; i < N; ++i) derivative[i - 1] = static_cast<double>(i) * c[i];

  Roots roots;
  double from = low;
  int signFrom = 0;
  // Takes the next end of a monotone piece, in order; `zero` is the relative size that counts as zero there.
  auto piece = [&](double to, double zero, bool first) {
    const Value v = valueAt(c, to);
    const int sign = std::abs(v.value) <= zero * v.size ? 0 : v.value < 0 ? -1 : 1;
    if (first) {
      if (sign == 0) roots.add(to);
    } else if (sign == 0) {
      if (signFrom != 0) roots.add(to);
    } else if (sign == -signFrom) {
      roots.add(closeIn(c, from, to, signFrom < 0));
    }
    from = to;
    signFrom = sign;
  };
  piece(low, 0, true);
  for (const double turn : find(derivative, low, high)) piece(turn, kZeroAtTurn, false);
  piece(high, 0, false);
  return roots;
}

// Values so large or small that a discriminant would leave the range of a double are scaled first.
template <std::size_t N>
Roots findInRange(Coefficients<N> c, double low, double high) {
  double largest = 0;
  for (const double x : c) largest = std::isnan(x) ? HUGE_VAL : std::max(largest, std::abs(x));
  if (!(largest > 0 && largest < HUGE_VAL)) return {};
  if (!(largest > 0x1p-300 && largest < 0x1p300)) {
    const int exponent = std::ilogb(largest);
    for (double& x : c) x = std::ldexp(x, -exponent);
  }
  return find(c, low, high);
}

}  // namespace

double evaluate(const Quartic& polynomial, double x) { return valueAt(polynomial, x).value; }
Roots rootsBetween(const Cubic& polynomial, double low, double high) {
  return findInRange(polynomial, low, high);
}
Roots rootsBetween(const Quartic& polynomial, double low, double high) {
  return findInRange(polynomial, low, high);
}

}  // namespace rayshade
