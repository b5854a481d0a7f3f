// What exact_geometry.h says, of solids.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "rayshade/shapes/all.h"
#include "tests/support/oracle/exact_numbers.h"

namespace rayshade::exact {

template <class Real>
std::vector<Real> crossings(const Sphere& s, const Line<Real>& line) {
  const Point<Real> f = line.origin - Point<Real>(s.centre);
  return rootsOfQuadratic<Real>(dot(line.direction, line.direction), dot(f, line.direction),
                                dot(f, f) - Real(s.radius) * Real(s.radius));
}
template <class Real>
Site<Real> siteAt(const Sphere& s, const Line<Real>& line, const Real& t) {
  const Point<Real> p = line.at(t) - Point<Real>(s.centre);
  const Real far = length(p);
  return {far - Real(s.radius), far > 0 ? magnitude(Real(dot(p, line.direction) / far)) : Real(1), Real(-1)};
}

template <class Real>
std::vector<Real> crossings(const Box& b, const Line<Real>& line) {
  Real entry{-1e300}, exit{1e300};
  for (int axis = 0; axis < 3; ++axis) {
    const Real low = Real(b.low[axis]) - line.origin[axis], high = Real(b.high[axis]) - line.origin[axis];
    const Real& d = line.direction[axis];
    if (d == 0) {
      if (low > 0 || high < 0) return {};
      continue;
    }
    const Real toLow = low / d, toHigh = high / d;
    const Real& near = d > 0 ? toLow : toHigh;
    const Real& far = d > 0 ? toHigh : toLow;
    if (near > entry) entry = near;
    if (far < exit) exit = far;
  }
  if (entry > exit) return {};
  return {entry, exit};
}
template <class Real>
Site<Real> siteAt(const Box& b, const Line<Real>& line, const Real& t) {
  const Point<Real> p = line.at(t);
  Real most{-1e300}, beyond{0}, slope{0};
  for (int axis = 0; axis < 3; ++axis) {
    const Real below = Real(b.low[axis]) - p[axis], above = p[axis] - Real(b.high[axis]);
    const Real& out = below > above ? below : above;
    if (out > 0) beyond += out * out;
    if (out > most) {
      most = out;
      slope = magnitude(line.direction[axis]);
    }
  }
  return {beyond > 0 ? squareRoot(beyond) : most, slope, Real(-1)};
}

// The side of a frustum, endless; the rim is at its two ends.
template <class Real>
struct FrustumParts {
  Point<Real> from, axis;
  Real height;
  Point<Real> across;
  Real growth;
  FrustumParts(const Frustum& s, const Point<Real>& p)
      : from(p - Point<Real>(s.base)),
        axis(unit(Point<Real>(s.axis))),
        height(dot(from, axis)),
        across(from - height * axis),
        growth((Real(s.endRadius) - Real(s.radius)) / Real(s.length)) {}
};
template <class Real>
std::vector<Real> crossings(const Frustum& s, const Line<Real>& line) {
  const FrustumParts<Real> f(s, line.origin);
  const Real climb = dot(line.direction, f.axis);
  const Point<Real> e = line.direction - climb * f.axis;
  const Real there = Real(s.radius) + f.growth * f.height, widening = f.growth * climb;
  return rootsOfQuadratic<Real>(dot(e, e) - widening * widening, dot(f.across, e) - there * widening,
                                dot(f.across, f.across) - there * there);
}
template <class Real>
Site<Real> siteAt(const Frustum& s, const Line<Real>& line, const Real& t) {
  const FrustumParts<Real> f(s, line.at(t));
  const Real rho = length(f.across), lean = squareRoot(Real(1 + f.growth * f.growth));
  const Real climb = dot(line.direction, f.axis);
  const Real outward = rho > 0 ? Real(dot(line.direction, f.across) / rho) : Real(0);
  const Real below = -f.height, above = f.height - Real(s.length);
  return {(rho - Real(s.radius) - f.growth * f.height) / lean,
          magnitude(Real((outward - f.growth * climb) / lean)), below > above ? below : above};
}
template <class Real>
std::vector<Real> crossings(const Cylinder& s, const Line<Real>& line) {
  return crossings(s.side, line);
}
template <class Real>
Site<Real> siteAt(const Cylinder& s, const Line<Real>& line, const Real& t) {
  return siteAt(s.side, line, t);
}
template <class Real>
std::vector<Real> crossings(const Cone& s, const Line<Real>& line) {
  return crossings(s.side, line);
}
template <class Real>
Site<Real> siteAt(const Cone& s, const Line<Real>& line, const Real& t) {
  return siteAt(s.side, line, t);
}

template <class Real>
std::vector<Real> crossings(const Torus& s, const Line<Real>& line) {
  const Point<Real> start = line.origin - Point<Real>(s.centre), axis = unit(Point<Real>(s.axis));
  const Real size = Real(s.swept) + Real(s.tube), dd = dot(line.direction, line.direction);
  const Real tFoot = -dot(start, line.direction) / dd;
  const Point<Real> m = Real(1 / size) * (start + tFoot * line.direction);
  const Real R = Real(s.swept) / size, r = Real(s.tube) / size;
  if (dot(m, m) > 1) return {};
  const Real mz = dot(m, axis), dz = dot(line.direction, axis), md = dot(m, line.direction);
  const Real k = dot(m, m) + R * R - r * r, four = 4 * R * R;
  const std::vector<Real> quartic{
      Real(k * k - four * (dot(m, m) - mz * mz)), Real(4 * md * k - 2 * four * (md - mz * dz)),
      Real(4 * md * md + 2 * k * dd - four * (dd - dz * dz)), Real(4 * md * dd), Real(dd * dd)};
  std::vector<Real> t;
  for (const Real& x : rootsOf(quartic, Real(-1.5), Real(1.5))) t.push_back(tFoot + size * x);
  return t;
}
template <class Real>
Site<Real> siteAt(const Torus& s, const Line<Real>& line, const Real& t) {
  const Point<Real> q = line.at(t) - Point<Real>(s.centre), axis = unit(Point<Real>(s.axis));
  const Real z = dot(q, axis);
  const Point<Real> across = q - z * axis;
  const Real rho = length(across), R = Real(s.swept), r = Real(s.tube);
  const Real near = squareRoot(Real((rho - R) * (rho - R) + z * z)),
             far = squareRoot(Real((rho + R) * (rho + R) + z * z));
  const bool inner = magnitude(Real(far - r)) < magnitude(Real(near - r));
  const Real least = inner ? magnitude(Real(far - r)) : magnitude(Real(near - r));
  const Real side = inner ? rho + R : rho - R, whole = inner ? far : near;
  const Real outward = rho > 0 ? Real(dot(across, line.direction) / rho) : Real(0);
  const Real slope =
      whole > 0 ? magnitude(Real((side * outward + z * dot(axis, line.direction)) / whole)) : Real(0);
  return {(near < r) != (far < r) ? Real(-least) : least, slope, Real(-1)};
}

template <class Real>
std::vector<Real> crossings(const Blob& s, const Line<Real>& line) {
  struct Span {
    Real enter, leave, a, b, c, strength;  // density strength (a x^2 + b x + c)^2, x = t - tFoot
  };
  const Real dd = dot(line.direction, line.direction);
  const Real tFoot = -dot(line.origin - Point<Real>(s.balls[0].centre), line.direction) / dd;
  const Point<Real> foot = line.at(tFoot);
  std::vector<Span> spans;
  std::vector<Real> cuts;
  for (const Metaball& ball : s.balls) {
    const Real r(ball.radius);
    const Point<Real> f = foot - Point<Real>(ball.centre);
    const Real b = dot(f, line.direction), c = dot(f, f) - r * r;
    const Real discriminant = b * b - dd * c;
    if (!(discriminant > 0)) continue;
    const Real root = squareRoot(discriminant);
    spans.push_back({Real((-b - root) / dd), Real((-b + root) / dd), Real(-dd / (r * r)),
                     Real(-2 * b / (r * r)), Real(-c / (r * r)), Real(ball.strength)});
    cuts.push_back(spans.back().enter);
    cuts.push_back(spans.back().leave);
  }
  std::sort(cuts.begin(), cuts.end());
  std::vector<Real> found;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const Real from = cuts[i], wide = cuts[i + 1] - cuts[i];
    if (!(wide > 0)) continue;
    // With x = from + wide y, so that all is of size 1.
    std::vector<Real> quartic{-Real(s.threshold), Real(0), Real(0), Real(0), Real(0)};
    for (const Span& span : spans) {
      if (!(span.enter <= from && span.leave >= cuts[i + 1])) continue;
      const Real a = span.a * wide * wide, b = (2 * span.a * from + span.b) * wide,
                 c = (span.a * from + span.b) * from + span.c;
      const Real terms[5] = {Real(c * c), Real(2 * b * c), Real(b * b + 2 * a * c), Real(2 * a * b),
                             Real(a * a)};
      for (std::size_t k = 0; k < 5; ++k) quartic[k] += span.strength * terms[k];
    }
    for (const Real& y : rootsOf(quartic, Real(0), Real(1))) found.push_back(tFoot + from + wide * y);
  }
  return found;
}
template <class Real>
Site<Real> siteAt(const Blob& s, const Line<Real>& line, const Real& t) {
  const Point<Real> p = line.at(t);
  Real value = -Real(s.threshold), bend{0};
  Point<Real> gradient;
  for (const Metaball& ball : s.balls) {
    const Real r(ball.radius), strength(ball.strength);
    const Point<Real> q = Real(1 / r) * (p - Point<Real>(ball.centre));
    const Real inside = 1 - dot(q, q);
    bend += 8 * strength / (r * r);
    if (!(inside > 0)) continue;
    value += strength * inside * inside;
    gradient = gradient - Real(4 * strength / r * inside) * q;
  }
  const Real steep = length(gradient), size = magnitude(value);
  // The skin is no nearer than that: value <= steep x + bend x^2 / 2.
  const Real least =
      size > 0 ? Real(2 * size / (steep + squareRoot(Real(steep * steep + 2 * bend * size)))) : Real(0);
  const Real slope = steep > 0 ? magnitude(Real(dot(gradient, line.direction) / steep)) : Real(0);
  return {value < 0 ? least : Real(-least), slope, Real(-1)};
}

}  // namespace rayshade::exact
