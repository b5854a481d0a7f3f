// Where a line meets each shape, and how far a point of the line is from it, in any number type.
//
// The plain definitions of the surfaces, written for clearness and not for speed: with Exact (256 bits) their rounding
// is far below everything that is asked of doubles; with long double they are a quick first look.  What a shape stores
// is taken as exact, but for unit vectors, which are of length 1 here.
//
// A shape is one or several parts.  Of a part are asked
//   crossings   the t at which the line meets its carrier: the surface without its rim (a plane for a triangle, an
//               endless cone for a cone)
//   siteAt      for a point of the line: its distance from the carrier, with a sign that changes where it is crossed;
//               how squarely the line goes there, |n.d|; how far beyond the rim the point is, along the surface
//
// Sources: the formulas of the headers in rayshade/shapes, as definitions; roots of quartics lie between those of their
// derivatives (Rolle).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "rayshade/shapes/all.h"

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

// -------------------------------------------------------------------------------------------------- solids

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

// ------------------------------------------------------------------------------------------------ flat things

template <class Real>
std::vector<Real> crossPlane(const Line<Real>& line, Vec3 point, const Point<Real>& normal) {
  const Real slope = dot(normal, line.direction);
  if (slope == 0) return {};
  return {dot(normal, Point<Real>(point) - line.origin) / slope};
}
template <class Real>
Real fromSegment(const Point<Real>& p, const Point<Real>& a, const Point<Real>& b) {
  const Point<Real> edge = b - a;
  const Real along = dot(edge, edge);
  Real s = along > 0 ? Real(dot(p - a, edge) / along) : Real(0);
  if (s < 0) s = 0;
  if (s > 1) s = 1;
  return length(p - a - s * edge);
}
// How far beyond the outline a point of its plane is; the outline is inside where it winds around.
template <class Real, class Corners>
Real beyondOutline(const Point<Real>& p, const Corners& corners, const Point<Real>& normal) {
  const Point<Real> n{magnitude(normal.x), magnitude(normal.y), magnitude(normal.z)};
  const int axis = n.x > n.y ? (n.x > n.z ? 0 : 2) : (n.y > n.z ? 1 : 2);
  const int first = (axis + 1) % 3, second = (axis + 2) % 3;
  Real least{1e300};
  int winding = 0;
  Point<Real> a(corners[corners.size() - 1]);
  for (const Vec3& corner : corners) {
    const Point<Real> b(corner);
    const Real near = fromSegment(p, a, b);
    if (near < least) least = near;
    if ((a[second] <= p[second]) != (b[second] <= p[second])) {
      const Real side =
          (a[first] - p[first]) * (b[second] - p[second]) - (a[second] - p[second]) * (b[first] - p[first]);
      if ((b[second] > p[second]) == (side > 0)) winding += b[second] > p[second] ? 1 : -1;
    }
    a = b;
  }
  return winding != 0 ? Real(-least) : least;
}
template <class Real, class Corners>
Site<Real> siteOnOutline(const Line<Real>& line, const Real& t, const Corners& corners,
                         const Point<Real>& normal) {
  const Point<Real> p = line.at(t);
  const Real away = dot(normal, p - Point<Real>(corners[0]));
  return {away, magnitude(dot(normal, line.direction)), beyondOutline(p - away * normal, corners, normal)};
}

template <class Real>
std::vector<Real> crossings(const Plane& s, const Line<Real>& line) {
  return crossPlane(line, s.point, Point<Real>(s.normal));
}
template <class Real>
Site<Real> siteAt(const Plane& s, const Line<Real>& line, const Real& t) {
  const Point<Real> n = unit(Point<Real>(s.normal));
  return {dot(n, line.at(t) - Point<Real>(s.point)), magnitude(dot(n, line.direction)), Real(-1)};
}
template <class Real>
std::vector<Real> crossings(const Disc& s, const Line<Real>& line) {
  return crossPlane(line, s.centre, Point<Real>(s.normal));
}
template <class Real>
Site<Real> siteAt(const Disc& s, const Line<Real>& line, const Real& t) {
  const Point<Real> n = unit(Point<Real>(s.normal)), from = line.at(t) - Point<Real>(s.centre);
  const Real away = dot(n, from);
  return {away, magnitude(dot(n, line.direction)), length(from - away * n) - Real(s.radius)};
}
template <class Real>
Point<Real> normalOf(const Triangle& s) {
  const Point<Real> a(s.corners[0]);
  return unit(cross(Point<Real>(s.corners[1]) - a, Point<Real>(s.corners[2]) - a));
}
template <class Real>
std::vector<Real> crossings(const Triangle& s, const Line<Real>& line) {
  return crossPlane(line, s.corners[0], normalOf<Real>(s));
}
template <class Real>
Site<Real> siteAt(const Triangle& s, const Line<Real>& line, const Real& t) {
  return siteOnOutline(line, t, s.corners, normalOf<Real>(s));
}
template <class Real>
std::vector<Real> crossings(const Polygon& s, const Line<Real>& line) {
  return crossPlane(line, s.corners[0], Point<Real>(s.normal));
}
template <class Real>
Site<Real> siteAt(const Polygon& s, const Line<Real>& line, const Real& t) {
  return siteOnOutline(line, t, s.corners, unit(Point<Real>(s.normal)));
}

// ---------------------------------------------------------------------------------------------------- parts

// The parts of a shape; most are one.
template <class S>
std::vector<S> partsOf(const S& shape) {
  return {shape};
}
inline std::vector<Triangle> partsOf(const PhongTriangle& shape) { return {shape.face}; }
inline std::vector<Triangle> partsOf(const TriangleUv& shape) { return {shape.phong.face}; }
inline std::vector<Triangle> partsOf(const HeightField& shape) {
  const Heights& h = *shape.heights;
  const auto corner = [&](int x, int y) {
    const double cells = h.size - 1;
    return Vec3{x / cells, y / cells, h.values[static_cast<std::size_t>(y * h.size + x)]};
  };
  std::vector<Triangle> triangles;
  for (int y = 0; y + 1 < h.size; ++y)
    for (int x = 0; x + 1 < h.size; ++x) {
      triangles.push_back({{corner(x, y), corner(x + 1, y), corner(x, y + 1)}});
      triangles.push_back({{corner(x + 1, y + 1), corner(x, y + 1), corner(x + 1, y)}});
    }
  return triangles;
}

}  // namespace rayshade::exact
