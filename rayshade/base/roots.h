// Real roots of cubic and quartic polynomials on an interval.
//
// Between two turning points a polynomial is monotone, so it has a root there exactly when its sign changes;
// the turning points are the roots of the derivative, found the same way, down to the quadratic formula.
// Each root is then closed in by Newton steps that may not leave their bracket.  A turning point whose value
// is zero within the rounding of the coefficients is a root of its own (a tangent ray touches).  So every
// root that is given back is the exact root of a polynomial whose coefficients differ by a few units in the
// last place, and no other is: closed formulas (Ferrari, Cardano) lose or invent roots when they cancel.
// All limits are relative: a polynomial scaled by a power of two, in x or in value, has the same roots' bits.
// Source of the bracketed Newton: Press et al., Numerical Recipes, 3rd ed. 2007, section 9.4.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

namespace rayshade {

using Cubic = std::array<double, 4>;    // c[0] + c[1] x + c[2] x^2 + c[3] x^3
using Quartic = std::array<double, 5>;  // ... + c[4] x^4

// Roots in ascending order; a multiple root is given once.
struct Roots {
  std::array<double, 4> at{};
  std::size_t count = 0;

  void add(double x) { at[count++] = x; }
  const double* begin() const { return at.data(); }
  const double* end() const { return at.data() + count; }
};

// The value at x, by Horner's rule; rootsBetween() takes its signs from these very numbers.
double evaluate(const Quartic& polynomial, double x);

// The roots in [low, high], low <= high, both finite.  Coefficients that are not finite have no roots.
Roots rootsBetween(const Cubic& polynomial, double low, double high);
Roots rootsBetween(const Quartic& polynomial, double low, double high);

}  // namespace rayshade
