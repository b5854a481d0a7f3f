// Points, lines and polynomials in any number type; Exact has 256 bits.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "rayshade/shapes/shape.h"

namespace rayshade::exact {

namespace mp = boost::multiprecision;
using Exact = mp::number<mp::cpp_bin_float<256, mp::digit_base_2>, mp::et_off>;

template <class Real>
struct Point {
  Real x{0}, y{0}, z{0};
  Point() = default;
  Point(Real x, Real y, Real z) : x(x), y(y), z(z) {}
  explicit Point(Vec3 v) : x(v.x), y(v.y), z(v.z) {}
  const Real& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};
template <class Real>
Point<Real> operator+(const Point<Real>& a, const Point<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
Point<Real> operator-(const Point<Real>& a, const Point<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
Point<Real> operator*(const Real& s, const Point<Real>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class Real>
Real dot(const Point<Real>& a, const Point<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
Point<Real> cross(const Point<Real>& a, const Point<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Real>
Real magnitude(const Real& x) {
  return x < 0 ? Real(-x) : x;
}
template <class Real>
Real squareRoot(const Real& x) {
  using std::sqrt;
  return x > 0 ? Real(sqrt(x)) : Real(0);
}
template <class Real>
Real length(const Point<Real>& a) {
  return squareRoot(dot(a, a));
}
template <class Real>
Point<Real> unit(const Point<Real>& a) {
  const Real l = length(a);
  return l > 0 ? Real(1 / l) * a : a;
}

template <class Real>
struct Line {
  Point<Real> origin, direction;
  explicit Line(const LocalRay& ray) : origin(ray.origin), direction(ray.direction) {}
  Point<Real> at(const Real& t) const { return origin + t * direction; }
};

template <class Real>
struct Site {
  Real distance{0};    // from the carrier; the sign changes where the line crosses it
  Real slope{1};       // |n.d|
  Real overshoot{-1};  // > 0: beyond the rim
};

// ------------------------------------------------------------------------------------------------ polynomials

template <class Real>
Real valueAt(const std::vector<Real>& c, const Real& x) {
  Real v = c.back();
  for (std::size_t i = c.size() - 1; i-- > 0;) v = v * x + c[i];
  return v;
}

// The real roots of odd multiplicity in (low, high), ascending: between neighbouring turning points there is one
// exactly when the sign changes.
template <class Real>
std::vector<Real> rootsOf(const std::vector<Real>& c, const Real& low, const Real& high) {
  std::vector<Real> roots;
  if (c.size() < 2) return roots;
  std::vector<Real> slope;
  for (std::size_t i = 1; i < c.size(); ++i) slope.push_back(Real(static_cast<int>(i)) * c[i]);
  std::vector<Real> ends = rootsOf(slope, low, high);
  ends.insert(ends.begin(), low);
  ends.push_back(high);
  const int digits = std::numeric_limits<Real>::digits;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    Real a = ends[i], b = ends[i + 1];
    const bool negative = valueAt(c, a) < 0;
    if (negative == (valueAt(c, b) < 0)) continue;
    Real x = (a + b) / 2;
    for (int turn = 0; turn < 3 * digits; ++turn) {  // Newton's steps while they stay inside, else halves
      const Real v = valueAt(c, x), s = valueAt(slope, x);
      if (v == 0) break;
      ((v < 0) == negative ? a : b) = x;
      Real next = s != 0 ? Real(x - v / s) : a;
      if (!(next > a && next < b)) next = (a + b) / 2;
      const bool done =
          magnitude(Real(next - x)) <= std::numeric_limits<Real>::epsilon() * magnitude(next) / 2;
      x = next;
      if (done || !(a < b)) break;
    }
    roots.push_back(x);
  }
  return roots;
}

template <class Real>
std::vector<Real> rootsOfQuadratic(const Real& a, const Real& b, const Real& c) {  // a t^2 + 2 b t + c
  const Real discriminant = b * b - a * c;
  if (discriminant < 0) return {};
  const Real root = squareRoot(discriminant);
  const Real q = b > 0 ? Real(-(b + root)) : Real(root - b);
  std::vector<Real> t;
  if (a != 0) t.push_back(q / a);
  if (q != 0) t.push_back(c / q);
  return t;
}

}  // namespace rayshade::exact
