// What exact_geometry.h says, of flat things.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/shapes/all.h"
#include "tests/support/oracle/exact_numbers.h"

namespace rayshade::exact {

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

}  // namespace rayshade::exact
