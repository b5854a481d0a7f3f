// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/oracle/oracle.h"

#include <cstdio>
#include <functional>
#include <stdexcept>

#include "rayshade/accel/bvh.h"
#include "rayshade/shading/surface_point.h"
#include "rayshade/space/clip_list.h"
#include "rayshade/space/walk.h"
#include "tests/support/oracle/exact_geometry.h"

namespace rayshade {
namespace {

using exact::Exact;
using exact::Line;
using exact::Point;
using exact::Site;

constexpr double kUnit = 0x1p-53;
constexpr double kBound = 16;  // [u M]
constexpr double kLeast = 1e-8, kMost = 1e8;

// ------------------------------------------------------------------------------------------------- randomness

class Dice {
 public:
  Dice(std::uint64_t seed, std::uint64_t number) : state_(mixBits(mixBits(seed) + number)) {}
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  int below(int n) { return static_cast<int>(bits() % static_cast<std::uint64_t>(n)); }
  bool oneIn(int n) { return below(n) == 0; }
  double sign() { return oneIn(2) ? 1 : -1; }
  double magnitude(double least, double most) { return std::exp(between(std::log(least), std::log(most))); }
  Vec3 direction() {
    const double z = between(-1, 1), turn = between(0, 6.283185307), r = std::sqrt(1 - z * z);
    return {r * std::cos(turn), r * std::sin(turn), z};
  }
  Vec3 axis() {
    Vec3 a;
    a[below(3)] = sign();
    return a;
  }
  Vec3 axisOrNearly() {
    if (oneIn(3)) return axis();
    if (oneIn(2)) return normalize(axis() + magnitude(1e-17, 1) * direction());
    return direction();
  }
  Vec3 across(Vec3 n) {  // a unit vector at right angles to n
    const Basis b = basisAround(n);
    const double turn = oneIn(4) ? 0 : between(0, 6.283185307);
    return normalize(std::cos(turn) * b.first + std::sin(turn) * b.second);
  }
  double size() { return magnitude(kLeast, kMost); }
  Vec3 placeOf(double size) {
    switch (below(4)) {
      case 0:
        return {};
      case 1:
        return magnitude(kLeast, kMost) * direction();
      default:
        return size * magnitude(1e-2, 1e3) * direction();
    }
  }
  // Often 0, 1 or a half.
  double share() { return oneIn(3) ? below(3) / 2.0 : unit(); }

 private:
  std::uint64_t bits() { return mixBits(state_ += 0x9e3779b97f4a7c15u); }
  std::uint64_t state_;
};

// --------------------------------------------------------------------------- shapes, and places on them to aim at

struct Spot {
  Vec3 point, normal;
};

double make(Dice& dice, Sphere& s) {
  s.radius = dice.size();
  s.centre = dice.placeOf(s.radius);
  return s.radius;
}
Spot spotOn(Dice& dice, const Sphere& s) {
  const Vec3 n = dice.axisOrNearly();
  return {s.centre + s.radius * n, n};
}

double make(Dice& dice, Box& b) {
  const double size = dice.size();
  const Vec3 place = dice.placeOf(size);
  const auto side = [&] { return size * (dice.oneIn(2) ? 1 : dice.magnitude(1e-6, 1)); };
  do {
    b.low = place;
    b.high = place + Vec3{side(), side(), side()};
  } while (!(b.low.x < b.high.x && b.low.y < b.high.y && b.low.z < b.high.z));
  return size;
}
Spot spotOn(Dice& dice, const Box& b) {  // on a face, often on an edge or a corner
  Spot spot;
  for (int axis = 0; axis < 3; ++axis) {
    const double share = dice.share();
    spot.point[axis] = share == 0   ? b.low[axis]
                       : share == 1 ? b.high[axis]
                                    : b.low[axis] + share * (b.high[axis] - b.low[axis]);
  }
  const int face = dice.below(3);
  const bool high = dice.oneIn(2);
  spot.point[face] = high ? b.high[face] : b.low[face];
  spot.normal[face] = high ? 1 : -1;
  return spot;
}

double make(Dice& dice, Plane& p) {
  p.point = dice.placeOf(dice.size());
  p.normal = dice.axisOrNearly();
  return dice.size();
}
Spot spotOn(Dice& dice, const Plane& p) {
  return {p.point + (dice.oneIn(4) ? 0 : dice.size()) * dice.across(p.normal), p.normal};
}

double make(Dice& dice, Disc& d) {
  d.radius = dice.size();
  d.centre = dice.placeOf(d.radius);
  d.normal = dice.axisOrNearly();
  return d.radius;
}
Spot spotOn(Dice& dice, const Disc& d) {
  return {d.centre + dice.share() * d.radius * dice.across(d.normal), d.normal};
}

double make(Dice& dice, Frustum& f, bool cone) {
  for (;;) {
    const double size = dice.size(), radius = size * (dice.oneIn(2) ? 1 : dice.magnitude(1e-4, 1));
    const double length = size * (dice.oneIn(2) ? 1 : dice.magnitude(1e-4, 1));
    const double other = !cone ? radius : dice.oneIn(2) ? 0 : radius * dice.unit();
    const Vec3 base = dice.placeOf(size);
    const auto made = frustumBetween(base, other, base + length * dice.axisOrNearly(), radius);
    if (!made) continue;
    f = *made;
    return size;
  }
}
Spot spotOn(Dice& dice, const Frustum& f) {  // often at an end: the apex of a cone is one
  const double share = dice.share();
  const Vec3 outward = dice.across(f.axis);
  const Vec3 normal = normalize(f.length * outward - (f.endRadius - f.radius) * f.axis);
  return {f.base + share * f.length * f.axis + (f.radius + share * (f.endRadius - f.radius)) * outward,
          normal};
}
double make(Dice& dice, Cylinder& c) { return make(dice, c.side, false); }
double make(Dice& dice, Cone& c) { return make(dice, c.side, true); }
Spot spotOn(Dice& dice, const Cylinder& c) { return spotOn(dice, c.side); }
Spot spotOn(Dice& dice, const Cone& c) { return spotOn(dice, c.side); }

double make(Dice& dice, Triangle& t) {
  for (;;) {
    const double size = dice.size();
    const Vec3 place = dice.placeOf(size);
    const bool needle = dice.oneIn(4);
    const Vec3 along = dice.direction();
    for (Vec3& corner : t.corners)
      corner = needle ? place + size * dice.between(-1, 1) * along +
                            size * dice.magnitude(1e-8, 1e-2) * dice.direction()
                      : place + size * dice.axisOrNearly();
    if (t.hasArea()) return size;
  }
}
Spot spotOn(Dice& dice, const Triangle& t) {  // a corner, a point of an edge, or of the inside
  double b = dice.share(), c = dice.oneIn(2) ? 0 : dice.unit() * (1 - b);
  const int turn = dice.below(3);
  const Vec3 from = t.corners[static_cast<std::size_t>(turn)];
  return {from + b * (t.corners[static_cast<std::size_t>((turn + 1) % 3)] - from) +
              c * (t.corners[static_cast<std::size_t>((turn + 2) % 3)] - from),
          t.normal()};
}
double make(Dice& dice, PhongTriangle& t) {
  const double size = make(dice, t.face);
  for (Vec3& n : t.normals) n = t.face.normal() + 0.4 * dice.direction();
  return size;
}
double make(Dice& dice, TriangleUv& t) { return make(dice, t.phong); }
Spot spotOn(Dice& dice, const PhongTriangle& t) { return spotOn(dice, t.face); }
Spot spotOn(Dice& dice, const TriangleUv& t) { return spotOn(dice, t.phong.face); }

double make(Dice& dice, Polygon& p) {  // a star around its centre, now and then one that crosses itself
  for (;;) {
    const double size = dice.size();
    const Vec3 place = dice.placeOf(size), normal = dice.axisOrNearly();
    const Basis axes = basisAround(normal);
    const int corners = 3 + dice.below(12);
    const int winds = dice.oneIn(4) ? 2 : 1;
    const bool regular = dice.oneIn(3);
    p = {};
    p.corners.clear();
    for (int i = 0; i < corners; ++i) {
      const double turn = 6.283185307179586 * winds * i / corners,
                   r = size * (regular ? 1 : dice.between(0.2, 1));
      p.corners.push_back(place + r * std::cos(turn) * axes.first + r * std::sin(turn) * axes.second);
    }
    p.prepare();
    // Newell's normal of the corners as rounded, the way Polygon::parse() has it.
    Vec3 sum;
    for (std::size_t i = 1; i + 1 < p.corners.size(); ++i)
      sum = sum + cross((p.corners[i] - p.corners[0]) / size, (p.corners[i + 1] - p.corners[0]) / size);
    if (!(length(sum) > 1e-2)) continue;
    p.normal = normalize(sum);
    bool flat = true;
    for (const Vec3& corner : p.corners)
      flat = flat && std::abs(dot(corner - p.corners[0], p.normal)) <= kUnit * 4 * (maxAbs(place) + size);
    if (!flat) continue;
    p.prepare();
    return size;
  }
}
Spot spotOn(Dice& dice, const Polygon& p) {
  const std::size_t i = static_cast<std::size_t>(dice.below(static_cast<int>(p.corners.size())));
  const Vec3 a = p.corners[i], b = p.corners[(i + 1) % p.corners.size()],
             c = p.corners[(i + 2) % p.corners.size()];
  return {a + dice.share() * (b - a) + (dice.oneIn(2) ? 0 : dice.unit() / 2) * (c - a), p.normal};
}

double make(Dice& dice, Torus& t) {
  t.swept = dice.size();
  t.tube = t.swept * dice.magnitude(1e-4, 2);
  t.axis = dice.axisOrNearly();
  t.centre = dice.placeOf(t.swept + t.tube);
  return t.swept + t.tube;
}
Spot spotOn(Dice& dice, const Torus& t) {
  const Vec3 axis = normalize(t.axis), outward = dice.across(axis);
  const double turn = dice.oneIn(3) ? dice.below(4) * 1.5707963267948966 : dice.between(0, 6.283185307);
  const Vec3 n = std::cos(turn) * outward + std::sin(turn) * axis;
  return {t.centre + t.swept * outward + t.tube * n, normalize(n)};
}

double make(Dice& dice, Blob& b) {
  const double size = dice.size();
  const Vec3 place = dice.placeOf(size);
  b.balls.clear();
  double least = 1e300;
  for (int i = 1 + dice.below(4); i > 0; --i) {
    const Vec3 at = b.balls.empty() ? place : place + size * dice.unit() * dice.direction();
    b.balls.push_back({at, size * dice.between(0.3, 1), dice.between(0.5, 2)});
    least = std::min(least, b.balls.back().strength);
  }
  b.threshold = least * dice.between(0.1, 0.9);
  return size;
}
Spot spotOn(Dice& dice, const Blob& b) {
  const Metaball& ball = b.balls[static_cast<std::size_t>(dice.below(static_cast<int>(b.balls.size())))];
  const Vec3 n = dice.axisOrNearly();
  return {ball.centre + ball.radius * std::sqrt(1 - std::sqrt(b.threshold / ball.strength)) * n, n};
}

double make(Dice& dice, HeightField& h) {
  const int size = 2 + dice.below(5);
  const double steep = dice.magnitude(1e-8, 900);
  std::vector<float> values;
  for (int i = 0; i < size * size; ++i) values.push_back(static_cast<float>(steep * dice.unit()));
  h.heights = makeHeights(size, std::move(values));
  return 1;
}
Spot spotOn(Dice& dice, const HeightField& h) {
  const std::vector<Triangle> triangles = exact::partsOf(h);
  return spotOn(dice, triangles[static_cast<std::size_t>(dice.below(static_cast<int>(triangles.size())))]);
}

// ------------------------------------------------------------------------------------------------------- rays

template <class S>
LocalRay rayAt(Dice& dice, const S& shape, double size) {
  const Spot spot = spotOn(dice, shape);
  Vec3 target = spot.point;
  switch (dice.below(4)) {
    case 0:
      target = target + dice.sign() * size * dice.magnitude(1e-17, 1e-1) * spot.normal;
      break;
    case 1:
      for (int axis = 0; axis < 3; ++axis)
        if (dice.oneIn(2)) target[axis] += dice.sign() * 2 * kUnit * std::max(std::abs(target[axis]), size);
      break;
  }
  Vec3 direction;
  switch (dice.below(4)) {
    case 0:  // along the surface, or nearly so
      direction = normalize(dice.across(spot.normal) +
                            (dice.oneIn(4) ? 0 : dice.sign() * dice.magnitude(1e-17, 1e-1)) * spot.normal);
      break;
    case 1:
      direction = dice.axisOrNearly();
      break;
    case 2: {  // through another spot of it
      const Vec3 way = target - spotOn(dice, shape).point;
      direction = way == Vec3{} ? dice.direction() : normalize(way);
      break;
    }
    default:
      direction = dice.direction();
  }
  const double distance = dice.oneIn(2) ? size * dice.magnitude(1e-3, 1e3) : dice.magnitude(kLeast, kMost);
  const Vec3 origin = target - distance * direction;
  // Half of them aim again from where rounding put the origin.
  if (dice.oneIn(2) && target != origin) direction = normalize(target - origin);
  return {origin, direction};
}

// ------------------------------------------------------------------------------------------------- the judgement

enum class Fault { none, phantom, missed, pointOff, selfHit };
const char* nameOf(Fault fault) {
  constexpr const char* kNames[] = {"none", "phantom", "missed", "pointOff", "selfHit"};
  return kNames[static_cast<int>(fault)];
}

struct Verdict {
  Fault fault = Fault::none;
  double t = 0;  // where
  double distance =
      0;  // of a hit, the worst of them                                                    [u M]
  std::uint64_t questions = 0;
};

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

  Leaving(Dice& dice, const S& shape, const LocalRay& from, double t) : at(shape.pointAt(from, t)) {
    SurfacePoint point;  // as evaluateSurface() makes it in the world's own space
    point.position = at.position;
    point.geometricNormal = at.geometricNormal;
    point.error = error = at.error + kRounding * maxAbs(at.position);
    const Vec3 n = at.geometricNormal;
    ray.direction =
        dice.oneIn(2)
            ? dice.direction()
            : normalize(dice.across(n) + (dice.oneIn(4) ? 0 : dice.sign() * dice.magnitude(1e-17, 1)) * n);
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

void count(OracleReport& report, const Verdict& verdict, const std::function<std::string()>& story) {
  report.questions += verdict.questions;
  report.worst = std::max(report.worst, verdict.fault == Fault::phantom ? 0 : verdict.distance);
  if (verdict.fault == Fault::none) return;
  ++report.failures;
  if (report.examples.size() < 10) report.examples.push_back(story());
}

// Decides with long double, and with 256 bits what that finds fault with.
template <class Look>
Verdict decide(OracleReport& report, std::uint64_t number, Look&& look) {
  const Verdict quick = look((long double)(0));
  if (quick.fault == Fault::none && quick.distance < kBound / 4 && number % 1024 != 0) return quick;
  ++report.doubtful;
  return look(Exact(0));
}

std::string hexadecimal(Vec3 v) {
  char text[120];
  std::snprintf(text, sizeof text, "(%a, %a, %a)", v.x, v.y, v.z);
  return text;
}

template <class S>
std::string story(std::string_view name, std::uint64_t seed, std::uint64_t number, const S& shape,
                  const LocalRay& ray, const Verdict& verdict) {
  char text[300];
  std::snprintf(text, sizeof text, "%.*s seed %llu case %llu: %s at t = %.17g, distance %.3g u M; ray ",
                int(name.size()), name.data(), static_cast<unsigned long long>(seed),
                static_cast<unsigned long long>(number), nameOf(verdict.fault), verdict.t, verdict.distance);
  std::string whole = text + hexadecimal(ray.origin) + " " + hexadecimal(ray.direction) + " shape";
  for (const std::byte b : encode(shape)) {
    std::snprintf(text, sizeof text, "%02x", static_cast<unsigned>(b));
    whole += text;
  }
  return whole;
}

template <class S>
void examineShape(OracleReport& report, std::string_view name, std::uint64_t seed, std::uint64_t number) {
  Dice dice(seed, number);
  S shape;
  const double size = make(dice, shape);
  const auto parts = exact::partsOf(shape);
  const double reach = reachOf(shape);
  const LocalRay ray = rayAt(dice, shape, size);
  const std::vector<double> roots = rootsOf(shape, ray);
  const Verdict verdict =
      decide(report, number, [&]<class Real>(Real) { return judge<Real>(parts, ray, roots, reach); });
  count(report, verdict, [&] { return story(name, seed, number, shape, ray, verdict); });
  if (roots.empty() || verdict.fault != Fault::none) return;
  const Leaving<S> leaving(dice, shape, ray, roots[0]);
  const Verdict left =
      decide(report, number, [&]<class Real>(Real) { return judgeLeaving<Real>(parts, leaving); });
  count(report, left, [&] { return story(name, seed, number, shape, leaving.ray, left); });
}

// ------------------------------------------------------------------------------------------------ fans of triangles

// Does the ring wind around the line?  Nothing when it comes too near to say.
template <class Real>
int windingAround(const std::vector<Vec3>& ring, const LocalRay& ray, double clearance) {
  const Line<Real> line(ray);
  const int axis = dominantAxis(ray.direction), first = (axis + 1) % 3, second = (axis + 2) % 3;
  const auto seen = [&](Vec3 corner) {  // across the ray, which is moved to the origin
    const Point<Real> from = Point<Real>(corner) - line.origin;
    const Real along = from[axis] / line.direction[axis];
    return Point<Real>{from[first] - along * line.direction[first],
                       from[second] - along * line.direction[second], Real(0)};
  };
  int winding = 0;
  Point<Real> a = seen(ring.back());
  for (const Vec3& corner : ring) {
    const Point<Real> b = seen(corner);
    if (!(exact::fromSegment({}, a, b) > Real(clearance))) return 0;
    if ((a.y <= 0) != (b.y <= 0)) {
      const Real side = a.x * b.y - a.y * b.x;
      if ((b.y > 0) == (side > 0)) winding += b.y > 0 ? 1 : -1;
    }
    a = b;
  }
  return winding;
}

void examineFan(OracleReport& report, std::string_view name, std::uint64_t seed, std::uint64_t number) {
  Dice dice(seed, number);
  const double size = dice.size();
  const Vec3 middle = dice.placeOf(size), axis = dice.direction();
  const Basis across = basisAround(axis);
  std::vector<Vec3> ring;
  const int corners = 3 + dice.below(6);
  for (int i = 0; i < corners; ++i) {
    const double turn = 6.283185307 * i / corners, r = size * (dice.oneIn(4) ? dice.magnitude(1e-3, 1) : 1);
    ring.push_back(middle + r * (std::cos(turn) * across.first + std::sin(turn) * across.second +
                                 dice.between(-0.3, 0.3) * axis));
  }
  std::vector<Triangle> fan;
  for (std::size_t i = 0; i < ring.size(); ++i)
    fan.push_back({{middle, ring[i], ring[(i + 1) % ring.size()]}});
  // At the vertex, a point of an inner edge, or one that is an ulp off.
  const Vec3 rim = ring[static_cast<std::size_t>(dice.below(corners))];
  Vec3 target = middle + (dice.oneIn(3) ? 0 : dice.unit()) * (rim - middle);
  if (dice.oneIn(4)) target[dice.below(3)] *= 1 + dice.sign() * 2 * kUnit;
  const double distance = dice.oneIn(2) ? size * dice.magnitude(1e-1, 1e3) : dice.magnitude(kLeast, kMost);
  const Vec3 toward = dice.oneIn(4)   ? dice.axis()
                      : dice.oneIn(2) ? dice.direction()
                                      : normalize(axis + 0.5 * dice.direction());
  LocalRay ray{target - distance * toward, toward};
  if (dice.oneIn(2) && target != ray.origin) ray.direction = normalize(target - ray.origin);

  bool met = false;
  for (const Triangle& triangle : fan) met = met || triangle.intersect(ray, -kInfinity) != kNoHit;
  double reach = maxAbs(middle);
  for (const Vec3& corner : ring) reach = std::max(reach, maxAbs(corner));
  const double clearance = 4 * kBound * kUnit * (maxAbs(ray.origin) + reach);
  Verdict verdict;
  if (windingAround<long double>(ring, ray, clearance) != 0) {
    ++report.questions;
    if (!met) {
      ++report.doubtful;
      if (windingAround<Exact>(ring, ray, clearance) != 0) verdict.fault = Fault::missed;
    }
  }
  count(report, verdict, [&] {
    return story(name, seed, number, fan[0], ray, verdict) + " (a leak; around its first corner)";
  });
}

// ------------------------------------------------------------------------------------------------ boxes and cuts

// Does the line touch the box at some t >= 0?  Products instead of quotients: with 256 bits this is exact.
bool touchesExactly(const Bounds& b, const LocalRay& ray) {
  struct Share {
    Exact over, under;  // over / under, under > 0
  };
  std::vector<Share> enters{{Exact(0), Exact(1)}}, leaves;
  for (int axis = 0; axis < 3; ++axis) {
    const Exact d(ray.direction[axis]), low = Exact(b.low[axis]) - Exact(ray.origin[axis]),
                                        high = Exact(b.high[axis]) - Exact(ray.origin[axis]);
    if (d == 0) {
      if (low > 0 || high < 0) return false;
    } else if (d > 0) {
      enters.push_back({low, d});
      leaves.push_back({high, d});
    } else {
      enters.push_back({Exact(-high), Exact(-d)});
      leaves.push_back({Exact(-low), Exact(-d)});
    }
  }
  for (const Share& in : enters)
    for (const Share& out : leaves)
      if (in.over * out.under > out.over * in.under) return false;
  return true;
}

void examineSlab(OracleReport& report, std::string_view name, std::uint64_t seed, std::uint64_t number) {
  Dice dice(seed, number);
  Box box;
  const double size = make(dice, box);
  // A second one, so that the boxes lie in a tree whose root is larger than they are.
  Box other;
  make(dice, other);
  const Bounds items[] = {box.bounds(), other.bounds()};
  const LocalRay ray = rayAt(dice, box, size);
  bool visited = false;
  const Bvh bvh(items);
  bvh.any(ray.origin, ray.direction, 0, kInfinity, [&](std::uint32_t first, std::uint32_t n) {
    for (std::uint32_t i = first; i < first + n; ++i) visited = visited || bvh.order()[i] == 0;
    return false;
  });
  Verdict verdict;
  ++report.questions;
  if (!visited) {
    ++report.doubtful;
    if (touchesExactly(items[0], ray)) verdict.fault = Fault::missed;
  }
  count(report, verdict, [&] { return story(name, seed, number, box, ray, verdict) + " (lost)"; });
}

// A tree of random cuts; the code of its nodes, in pre-order.
BinTree randomTree(Dice& dice, const Bounds& world, int cuts) {
  TreeCode code;
  const auto grow = [&](auto&& self, Bounds box, int left) -> void {
    const int axis = dice.below(3);
    const double split = box.low[axis] + dice.unit() * (box.high[axis] - box.low[axis]);
    const std::uint8_t starts = code.kinds.empty() ? 4 : 0;
    if (left == 0 || !(split > box.low[axis] && split < box.high[axis])) {
      code.kinds.push_back(static_cast<std::uint8_t>(3 + starts));
      return;
    }
    code.kinds.push_back(static_cast<std::uint8_t>(axis + starts));
    code.splits.push_back(split);
    Bounds low = box, high = box;
    low.high[axis] = high.low[axis] = split;
    const int below = dice.below(left);
    self(self, low, below);
    self(self, high, left - 1 - below);
  };
  grow(grow, world, cuts);
  return treeFrom(code).value();
}

struct TreeCase {
  BinTree tree;
  LocalRay ray;
  double size;
};
TreeCase treeCase(Dice& dice) {
  Box world;
  const double size = make(dice, world);
  TreeCase c{randomTree(dice, world.bounds(), 1 + dice.below(12)), {}, size};
  // Aimed at planes, edges and corners of the tree.
  Box cell = world;
  const auto node = static_cast<std::uint32_t>(dice.below(static_cast<int>(cellCount(c.tree))));
  const Bounds bounds = boundsOf(c.tree, CellId{node});
  for (int axis = 0; axis < 3; ++axis) {
    if (std::isfinite(bounds.low[axis])) cell.low[axis] = bounds.low[axis];
    if (std::isfinite(bounds.high[axis])) cell.high[axis] = bounds.high[axis];
  }
  c.ray = rayAt(dice, cell, size);
  return c;
}

// Every border lies where the exact plane is met, up to two roundings, and every cell that the exact ray goes through
// between two borders that differ by more than that is there.
void examineVoxel(OracleReport& report, std::string_view name, std::uint64_t seed, std::uint64_t number) {
  Dice dice(seed, number);
  const TreeCase c = treeCase(dice);
  const Line<Exact> line(c.ray);
  Verdict verdict;
  CellWalk walk(c.tree, c.ray.origin, c.ray.direction);
  WalkStep<CellId> step;
  double entered = 0;
  bool first = true;
  while (walk.next(step)) {
    ++report.questions;
    const Bounds cell = boundsOf(c.tree, step.where);
    if (step.tEnter != entered || (first && step.tEnter != 0)) verdict.fault = Fault::phantom;
    first = false;
    entered = step.tExit;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = c.ray.direction[axis], o = c.ray.origin[axis];
      // Somewhere in the step the exact ray is in the cell: enter <= its exit and exit >= its entry, on each axis.
      if (d == 0) {
        if (!(o >= cell.low[axis] && o < cell.high[axis])) verdict.fault = Fault::missed;
        continue;
      }
      const double near = d > 0 ? cell.low[axis] : cell.high[axis],
                   far = d > 0 ? cell.high[axis] : cell.low[axis];
      // In long double: an error of 2^-63 in a comparison that allows 2^-51.
      const auto at = [&](double plane) { return (static_cast<long double>(plane) - o) / d; };
      constexpr long double kSlack = 0x1p-51L;
      if (std::isfinite(near)) {
        const long double t = at(near);
        if (!(step.tExit >= t - kSlack * std::abs(t))) verdict.fault = Fault::missed;
        if (!(static_cast<long double>(step.tEnter) >= std::max(0.0L, t - kSlack * std::abs(t))))
          verdict.fault = Fault::missed;
      }
      if (std::isfinite(far)) {
        const long double t = at(far);
        if (!(static_cast<long double>(step.tExit) <= std::max(0.0L, t) + kSlack * std::abs(t)))
          verdict.fault = Fault::missed;
      }
    }
  }
  if (entered != kInfinity) verdict.fault = Fault::missed;
  count(report, verdict, [&] { return story(name, seed, number, c.tree, c.ray, verdict) + " (border)"; });
}

// A point that lies in the exact pyramid lies in a cell of the list.
void examinePyramid(OracleReport& report, std::string_view name, std::uint64_t seed, std::uint64_t number) {
  Dice dice(seed, number);
  const TreeCase c = treeCase(dice);
  const Vec3 apex = c.ray.origin;
  // Around the ray, from very thin to very wide; the ray itself may be a side.
  const Basis across = basisAround(c.ray.direction);
  const double wide = dice.magnitude(1e-9, 2), aside = dice.oneIn(2) ? 0 : wide;
  std::array<Vec3, 4> corners;
  for (int i = 0; i < 4; ++i)
    corners[static_cast<std::size_t>(i)] = c.ray.direction +
                                           (i == 1 || i == 2 ? wide : -aside) * across.first +
                                           (i >= 2 ? wide : -aside) * across.second;
  const std::vector<CellId> list = clipList(c.tree, pyramidOf(apex, corners));
  std::vector<bool> listed(cellCount(c.tree));
  for (const CellId cell : list) listed[static_cast<std::size_t>(cell)] = true;

  std::array<Point<Exact>, 4> inward;
  for (std::size_t k = 0; k < 4; ++k) {
    inward[k] = cross(Point<Exact>(corners[k]), Point<Exact>(corners[(k + 1) % 4]));
    if (dot(inward[k], Point<Exact>(corners[(k + 2) % 4])) < 0) inward[k] = Exact(-1) * inward[k];
  }

  Verdict verdict;
  for (int i = 0; i < 4; ++i) {
    Vec3 inside;
    for (const Vec3& corner : corners) inside = inside + dice.share() * corner;
    const double far = c.size * dice.magnitude(1e-4, 1e4);
    const Vec3 p = i == 0 ? apex : apex + far * inside;
    const Point<Exact> from = Point<Exact>(p) - Point<Exact>(apex);
    bool within = true;
    for (const Point<Exact>& side : inward) within = within && dot(side, from) >= 0;
    if (!within) continue;
    ++report.questions;
    std::uint32_t node = 0;
    while (!c.tree.nodes[node].leaf())
      node = p[c.tree.nodes[node].axis] < c.tree.nodes[node].split ? node + 1 : c.tree.nodes[node].high;
    if (!listed[c.tree.nodes[node].high]) verdict.fault = Fault::missed;
  }
  count(report, verdict, [&] {
    return story(name, seed, number, c.tree, c.ray, verdict) + " (a cell of the pyramid is lost)";
  });
}

using Examine = void (*)(OracleReport&, std::string_view, std::uint64_t, std::uint64_t);
constexpr std::string_view kNames[] = {
    "sphere",  "box",   "plane", "disc",        "cylinder", "cone", "triangle", "phongtriangle", "triangleuv",
    "polygon", "torus", "blob",  "heightfield", "fan",      "slab", "voxel",    "pyramid"};
constexpr Examine kExamine[] = {examineShape<Sphere>,
                                examineShape<Box>,
                                examineShape<Plane>,
                                examineShape<Disc>,
                                examineShape<Cylinder>,
                                examineShape<Cone>,
                                examineShape<Triangle>,
                                examineShape<PhongTriangle>,
                                examineShape<TriangleUv>,
                                examineShape<Polygon>,
                                examineShape<Torus>,
                                examineShape<Blob>,
                                examineShape<HeightField>,
                                examineFan,
                                examineSlab,
                                examineVoxel,
                                examinePyramid};
static_assert(std::size(kNames) == std::size(kExamine));

}  // namespace

std::span<const std::string_view> oracleClasses() { return kNames; }

OracleReport examine(std::string_view name, std::uint64_t seed, std::uint64_t first, std::uint64_t count) {
  for (std::size_t i = 0; i < std::size(kNames); ++i) {
    if (kNames[i] != name) continue;
    OracleReport report;
    for (std::uint64_t number = first; number < first + count; ++number)
      kExamine[i](report, name, seed, number);
    report.cases = count;
    return report;
  }
  throw std::invalid_argument("no class of that name: " + std::string(name));
}

}  // namespace rayshade
