// Hits of shapes, and rays that leave them.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shading/surface_point.h"
#include "tests/support/oracle/aims.h"
#include "tests/support/oracle/exact_geometry.h"
#include "tests/support/oracle/verdict.h"

namespace rayshade {
namespace {

using exact::Line;
using exact::Site;

template <class S>
std::vector<double> rootsOf(const S& shape, const LocalRay& ray) {
  std::vector<double> roots;
  for (double t = 0; roots.size() < 64 && (t = shape.intersect(ray, t)) != kNoHit;) roots.push_back(t);
  return roots;
}

double reachOf(const Bounds& b) {
  double reach = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {b.low[axis], b.high[axis]})
      if (std::isfinite(side)) reach = std::max(reach, std::abs(side));
  return reach;
}
template <class S>
double reachOf(const S& shape) {
  return reachOf(shape.bounds());
}
double reachOf(const Plane& plane) { return maxAbs(plane.point); }

template <class Real>
Real largerOf(const Real& a, const Real& b) {
  return a > b ? a : b;
}

// How far the point of the line at t is from the part: from its carrier, or beyond its rim by that over |n.d|.
template <class Real, class Part>
Real awayFrom(const Part& part, const Line<Real>& line, const Real& t) {
  const Site<Real> site = siteAt(part, line, t);
  return largerOf(exact::magnitude(site.distance), Real(site.overshoot * site.slope));
}

// What a bound is multiplied with.  The quartics of a blob are sums of many terms, and a touch is taken within their
// rounding.
template <class Part>
double conditionOf(const Part&) {
  return 1;
}
double conditionOf(const Blob&) { return 8; }

template <class Real, class Part>
Verdict judge(const std::vector<Part>& parts, const LocalRay& ray, const std::vector<double>& roots,
              double reach) {
  const Line<Real> line(ray);
  const double still = maxAbs(ray.origin) + reach;
  Verdict verdict;
  const auto fail = [&](Fault fault, double t) {
    if (verdict.fault == Fault::none) verdict.fault = fault, verdict.t = t;
  };
  for (const double t : roots) {
    const double size = kUnit * (still + std::abs(t));
    Real least{1e300};
    for (const Part& part : parts) {
      const Real away = awayFrom(part, line, Real(t)) / Real(conditionOf(part));
      if (away < least) least = away;
    }
    ++verdict.questions;
    const double distance = static_cast<double>(Real(least / Real(size)));
    verdict.distance = std::max(verdict.distance, distance);
    if (!(distance <= kBound)) fail(Fault::phantom, t);
  }
  for (const Part& part : parts)
    for (const Real& t : crossings(part, line)) {
      if (!(t > 0) || !(t < Real(1e290))) continue;
      const Site<Real> here = siteAt(part, line, t);
      if (!(here.slope > 0)) continue;
      const Real bound = Real(kBound * conditionOf(part) * kUnit) * (Real(still) + t),
                 about = 4 * bound / here.slope;
      if (!(t - about > 0) || !(-here.overshoot * here.slope > 4 * bound)) continue;
      const Real before = siteAt(part, line, Real(t - about)).distance,
                 after = siteAt(part, line, Real(t + about)).distance;
      const bool sure = (before > bound && after < -bound) || (before < -bound && after > bound);
      if (!sure) continue;
      ++verdict.questions;
      bool found = false;
      for (const double root : roots) found = found || (Real(root) >= t - about && Real(root) <= t + about);
      if (!found) fail(Fault::missed, static_cast<double>(t));
    }
  return verdict;
}

// Where nothing can be met again once it was left, on the outer side at least.
template <class S>
constexpr bool kConvex = !(std::same_as<S, Torus> || std::same_as<S, Blob> || std::same_as<S, HeightField>);
template <class S>
constexpr bool kSolid =
    std::same_as<S, Sphere> || std::same_as<S, Box> || std::same_as<S, Cylinder> || std::same_as<S, Cone>;

// The least radius of curvature or thickness near a point: what is not larger than its error has no side to leave to.
double bluntness(const Sphere& s, Vec3) { return s.radius; }
double bluntness(const Box& b, Vec3) {
  return std::min({b.high.x - b.low.x, b.high.y - b.low.y, b.high.z - b.low.z});
}
double bluntness(const Frustum& f, Vec3 p) {
  return length(cross(p - f.base, f.axis)) * f.length / std::hypot(f.length, f.endRadius - f.radius);
}
double bluntness(const Cylinder& c, Vec3 p) { return bluntness(c.side, p); }
double bluntness(const Cone& c, Vec3 p) { return bluntness(c.side, p); }
double bluntness(const Torus& t, Vec3 p) {
  return std::min(t.tube, length(cross(p - t.centre, normalize(t.axis))));
}
double bluntness(const Blob& b, Vec3) {
  double least = kInfinity;
  for (const Metaball& ball : b.balls) least = std::min(least, ball.radius);
  return least;
}
template <class S>
double bluntness(const S&, Vec3) {  // flat
  return kInfinity;
}

// How far the normal turns when the corners of a needle move by an error: a direction that is nearer to its plane goes to
// the one side by the kernel and to the other by the exact normal, and then the exact ray comes back as well.
double tilt(const Triangle& t, double error) {
  const Vec3 a = t.corners[1] - t.corners[0], b = t.corners[2] - t.corners[0];
  return error * std::max({length(a), length(b), length(b - a)}) / length(cross(a, b));
}
double tilt(const PhongTriangle& t, double error) { return tilt(t.face, error); }
double tilt(const TriangleUv& t, double error) { return tilt(t.phong, error); }
template <class S>
double tilt(const S&, double) {  // normals that are given, or those of round things
  return 0;
}

// A hit, and a ray that leaves it.
template <class S>
struct Leaving {
  ShapePoint at;
  LocalRay ray;
  double error = 0, slope = 0, bluntness = 0;
  double tilt = 0;
  double blur = 0;   // how well it is known where the ray met the surface
  bool away = true;  // to the outer side
  std::vector<double> roots;

  Leaving(HardRandom& random, const S& shape, const LocalRay& from, double t) : at(shape.pointAt(from, t)) {
    SurfacePoint point;  // as evaluateSurface() makes it in the world's own space
    point.position = at.position;
    point.geometricNormal = at.geometricNormal;
    point.error = error = at.error + kRounding * maxAbs(at.position);
    const Vec3 n = at.geometricNormal;
    ray.direction = random.oneIn(2)
                        ? random.direction()
                        : normalize(random.across(n) +
                                    (random.oneIn(4) ? 0 : random.sign() * random.magnitude(1e-17, 1)) * n);
    ray.origin = originOff(point, ray.direction);
    slope = std::abs(dot(n, ray.direction));
    bluntness = rayshade::bluntness(shape, at.position);
    tilt = rayshade::tilt(shape, at.error);
    blur = error + kBound * kUnit * (maxAbs(from.origin) + std::abs(t));
    away = dot(n, ray.direction) >= 0;
    roots = rootsOf(shape, ray);
  }
};

template <class Real, class S, class Part>
Verdict judgeLeaving(const std::vector<Part>& parts, const Leaving<S>& leaving) {
  Verdict verdict;
  LocalRay still = leaving.ray;
  still.origin = leaving.at.position;
  const Line<Real> there(still);
  Real off{1e300};
  for (const Part& part : parts) {
    const Real away = exact::magnitude(siteAt(part, there, Real(0)).distance);
    if (away < off) off = away;
  }
  ++verdict.questions;
  if (off > Real(leaving.at.error)) verdict.fault = Fault::pointOff;
  if (leaving.roots.empty() || leaving.bluntness < 64 * leaving.blur) return verdict;
  const double first = leaving.roots[0];
  const bool sideless = leaving.slope < leaving.tilt;
  bool again = kConvex<S> && (!kSolid<S> || leaving.away) && !sideless;
  if (!again && (sideless || (first * leaving.slope <= 64 * leaving.error &&
                              first <= 64 * std::sqrt(leaving.error * leaving.bluntness)))) {
    again = true;
    const Line<Real> line(leaving.ray);
    for (const Part& part : parts) {
      // The ray starts twice the error off the face that it leaves: what is nearer than one is another, in a fold.
      if (awayFrom(part, line, Real(first)) <= Real(leaving.error)) again = false;
      for (const Real& t : crossings(part, line))
        if (8 * t >= Real(first) && t <= Real(8 * first)) again = false;
    }
  }
  if (again) verdict = {Fault::selfHit, first, 0, verdict.questions};
  return verdict;
}

}  // namespace

template <class S>
void examineShape(OracleReport& report, std::string_view name, std::uint64_t seed, std::uint64_t number) {
  HardRandom random(seed, number);
  S shape;
  const double size = make(random, shape);
  const auto parts = exact::partsOf(shape);
  const double reach = reachOf(shape);
  const LocalRay ray = rayAt(random, shape, size);
  const std::vector<double> roots = rootsOf(shape, ray);
  const Verdict verdict =
      decide(report, number, [&]<class Real>(Real) { return judge<Real>(parts, ray, roots, reach); });
  count(report, verdict, [&] { return story(name, seed, number, shape, ray, verdict); });
  if (roots.empty() || verdict.fault != Fault::none) return;
  const Leaving<S> leaving(random, shape, ray, roots[0]);
  const Verdict left =
      decide(report, number, [&]<class Real>(Real) { return judgeLeaving<Real>(parts, leaving); });
  count(report, left, [&] { return story(name, seed, number, shape, leaving.ray, left); });
}

template Examine examineShape<Sphere>;
template Examine examineShape<Box>;
template Examine examineShape<Plane>;
template Examine examineShape<Disc>;
template Examine examineShape<Cylinder>;
template Examine examineShape<Cone>;
template Examine examineShape<Triangle>;
template Examine examineShape<PhongTriangle>;
template Examine examineShape<TriangleUv>;
template Examine examineShape<Polygon>;
template Examine examineShape<Torus>;
template Examine examineShape<Blob>;
template Examine examineShape<HeightField>;

}  // namespace rayshade
