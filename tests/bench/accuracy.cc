// Speed and error of each kernel, beside the textbook formula in its place.
//
//   accuracy [RAYS]          TSV on standard output; a million rays for each kernel, a tenth of them for the torus
//
// Shapes of about size 1 at the origin; rays come from 2 to 1e7 away (log-uniform) and aim at points in and around the shape, one in
// four at an edge, a corner or a silhouette.  The truth is computed with 256 bits (tests/support/oracle/exact_geometry.h).
//
//   ns          processor time per ray, the best of several turns over the first rays
//   typical     median error of t, in units in the last place of the true t
//   worst       largest error of t, likewise
//   rays        so many were judged
//   missed, phantom      per million rays: a hit that the kernel does not see, one that is not there
//   wrong       per million rays: those of them, and those hits, that rounding of the numbers given cannot excuse: a point
//               farther from the shape than the oracle's bound, nothing where the ray goes through it by more than that
//               (tests/support/oracle/oracle.h)
//
// The textbook formulas live here only.  Sources: sphere, cylinder, cone, box: Haines, and Kay & Kajiya, in Glassner, An Introduction
// to Ray Tracing, 1989, and as in Rayshade 4; triangle: Möller & Trumbore, JGT 2(1), 1997; torus: the quartic of the ray
// where it starts, solved by Ferrari's formula.
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "tests/support/oracle/exact_geometry.h"
#include "tests/support/random.h"

namespace rayshade {
namespace {

using exact::Exact;

// ------------------------------------------------------------------------------------------- textbook formulas

double firstOf(double a, double b) { return a > 0 ? a : b > 0 ? b : kNoHit; }

double textbook(const Sphere& s, const LocalRay& ray) {
  const Vec3 f = ray.origin - s.centre;
  const double b = -dot(f, ray.direction), discriminant = b * b - dot(f, f) + s.radius * s.radius;
  if (discriminant < 0) return kNoHit;
  const double root = std::sqrt(discriminant);
  return firstOf(b - root, b + root);
}

double textbook(const Box& box, const LocalRay& ray) {
  double entry = -kInfinity, exit = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    const double inverse = 1 / ray.direction[axis];
    const double a = (box.low[axis] - ray.origin[axis]) * inverse,
                 b = (box.high[axis] - ray.origin[axis]) * inverse;
    entry = std::max(entry, std::min(a, b));
    exit = std::min(exit, std::max(a, b));
  }
  return entry <= exit ? firstOf(entry, exit) : kNoHit;
}

double textbook(const Plane& p, const LocalRay& ray) {
  const double slope = dot(p.normal, ray.direction);
  if (std::abs(slope) < 1e-5) return kNoHit;
  const double t = (dot(p.normal, p.point) - dot(p.normal, ray.origin)) / slope;
  return t > 0 ? t : kNoHit;
}
double textbook(const Disc& d, const LocalRay& ray) {
  const double t = textbook(Plane{d.centre, d.normal}, ray);
  const Vec3 from = ray.origin + t * ray.direction - d.centre;
  return t < kNoHit && dot(from, from) <= d.radius * d.radius ? t : kNoHit;
}

double textbook(const Frustum& s, const LocalRay& ray) {
  const Vec3 from = ray.origin - s.base;
  const double height = dot(from, s.axis), climb = dot(ray.direction, s.axis);
  const Vec3 f = from - height * s.axis, e = ray.direction - climb * s.axis;
  const double there = s.radius + s.growth() * height, widening = s.growth() * climb;
  const double a = dot(e, e) - widening * widening, b = dot(f, e) - there * widening,
               c = dot(f, f) - there * there;
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return kNoHit;
  const double root = std::sqrt(discriminant);
  double nearest = kNoHit;
  for (const double t : {(-b - root) / a, (-b + root) / a})
    if (t > 0 && t < nearest && height + t * climb >= 0 && height + t * climb <= s.length) nearest = t;
  return nearest;
}
double textbook(const Cylinder& c, const LocalRay& ray) { return textbook(c.side, ray); }
double textbook(const Cone& c, const LocalRay& ray) { return textbook(c.side, ray); }

double textbook(const Triangle& t, const LocalRay& ray) {
  const Vec3 first = t.corners[1] - t.corners[0], second = t.corners[2] - t.corners[0];
  const Vec3 p = cross(ray.direction, second);
  const double determinant = dot(first, p);
  if (determinant == 0) return kNoHit;
  const Vec3 from = ray.origin - t.corners[0];
  const double u = dot(from, p) / determinant;
  if (u < 0 || u > 1) return kNoHit;
  const Vec3 q = cross(from, first);
  const double v = dot(ray.direction, q) / determinant;
  if (v < 0 || u + v > 1) return kNoHit;
  const double at = dot(second, q) / determinant;
  return at > 0 ? at : kNoHit;
}

double textbook(const Polygon& polygon,
                const LocalRay& ray) {  // crossings of a half-line, along the largest axis
  const double t = textbook(Plane{polygon.corners[0], polygon.normal}, ray);
  if (t == kNoHit) return kNoHit;
  const Vec3 p = ray.origin + t * ray.direction;
  const int axis = dominantAxis(polygon.normal), x = (axis + 1) % 3, y = (axis + 2) % 3;
  bool inside = false;
  for (std::size_t i = 0, k = polygon.corners.size() - 1; i < polygon.corners.size(); k = i++) {
    const Vec3 a = polygon.corners[i], b = polygon.corners[k];
    if ((a[y] > p[y]) != (b[y] > p[y]) && p[x] < (b[x] - a[x]) * (p[y] - a[y]) / (b[y] - a[y]) + a[x])
      inside = !inside;
  }
  return inside ? t : kNoHit;
}

double textbook(const Torus& torus, const LocalRay& ray) {  // axis z, centre at the origin; Ferrari
  using Complex = std::complex<double>;
  const Vec3 o = ray.origin, d = ray.direction;
  const double od = dot(o, d), k = dot(o, o) + torus.swept * torus.swept - torus.tube * torus.tube;
  const double four = 4 * torus.swept * torus.swept;
  const double c3 = 4 * od, c2 = 4 * od * od + 2 * k - four * (d.x * d.x + d.y * d.y),
               c1 = 4 * od * k - 2 * four * (o.x * d.x + o.y * d.y),
               c0 = k * k - four * (o.x * o.x + o.y * o.y);
  const double shift = c3 / 4, p = c2 - 6 * shift * shift,
               q = c1 - 2 * c2 * shift + 8 * shift * shift * shift,
               r = c0 - c1 * shift + c2 * shift * shift - 3 * shift * shift * shift * shift;
  // A root m of 8 m^3 + 8 p m^2 + (2 p^2 - 8 r) m - q^2.
  const Complex d0 = p * p + 12 * r, d1 = 2 * p * p * p + 27 * q * q - 72 * p * r;
  const Complex cube = std::pow((d1 + std::sqrt(d1 * d1 - 4.0 * d0 * d0 * d0)) / 2.0, 1.0 / 3);
  const Complex m = (cube + d0 / cube - 2 * p) / 6.0, s = std::sqrt(2.0 * m);
  double nearest = kNoHit;
  for (const double one : {1.0, -1.0})
    for (const double two : {1.0, -1.0}) {
      const Complex root = (one * s + two * std::sqrt(-(2 * p + 2.0 * m + one * 2 * q / s))) / 2.0 - shift;
      if (std::abs(root.imag()) < 1e-9 * std::abs(root) && root.real() > 0)
        nearest = std::min(nearest, root.real());
    }
  return nearest;
}

// ------------------------------------------------------------------------------------------------ measurement

constexpr double kReach = 1.5;  // of all shapes here

std::vector<LocalRay> raysAt(const std::vector<Vec3>& edges, std::size_t count) {
  Random random(1);
  std::vector<LocalRay> rays;
  while (rays.size() < count) {
    Vec3 target = std::cbrt(random.real()) * 1.2 * random.direction();
    if (!edges.empty() && rays.size() % 4 == 0) {
      const auto i = random.below(edges.size());
      const Vec3 a = edges[i], b = edges[(i + 1) % edges.size()];
      target = a + (rays.size() % 8 == 0 ? 0 : random.real()) * (b - a);
    }
    const Vec3 origin = target + random.magnitude(2, 1e7) * random.direction();
    rays.push_back({origin, normalize(target - origin)});
  }
  return rays;
}

template <class S>
double truth(const S& shape, const LocalRay& ray) {
  const exact::Line<Exact> line(ray);
  Exact nearest(1e300);
  for (const Exact& t : crossings(shape, line))
    if (t > 0 && t < nearest && siteAt(shape, line, t).overshoot <= 0) nearest = t;
  return nearest < Exact(1e299) ? static_cast<double>(nearest) : kNoHit;
}

// More than rounding of what is given can excuse?
template <class S>
bool isWrong(const S& shape, const LocalRay& ray, double truth, double answer) {
  const double t = answer < kNoHit ? answer : truth;
  if (t == kNoHit) return false;
  const exact::Line<Exact> line(ray);
  const Exact bound(kRounding * (maxAbs(ray.origin) + t + kReach));
  const auto here = siteAt(shape, line, Exact(t));
  if (answer < kNoHit) return exact::magnitude(here.distance) > bound || here.overshoot * here.slope > bound;
  if (!(-here.overshoot * here.slope > 4 * bound)) return false;
  const Exact about = 4 * bound / here.slope;
  const Exact before = siteAt(shape, line, Exact(t - about)).distance,
              after = siteAt(shape, line, Exact(t + about)).distance;
  return (before > bound && after < -bound) || (before < -bound && after > bound);
}

struct Measured {
  double ns, typical, worst, missed, phantom, wrong;
};

template <class S, class Formula>
Measured measure(const S& shape, const std::vector<LocalRay>& rays, const std::vector<double>& truths,
                 const Formula& formula) {
  std::vector<double> answers;
  for (const LocalRay& ray : rays) answers.push_back(formula(ray));
  // As many as stay in the cache.
  const std::size_t timed = std::min<std::size_t>(rays.size(), 4000);
  std::vector<double> again(timed);
  double best = kInfinity;
  for (int turn = 0; turn < 20; ++turn) {
    const std::clock_t begin = std::clock();
    for (int i = 0; i < 10; ++i)
      for (std::size_t k = 0; k < timed; ++k) again[k] = formula(rays[k]);
    best = std::min(best, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / 10);
  }
  std::vector<double> errors;
  double missed = 0, phantom = 0, wrong = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool hit = answers[i] < kNoHit, there = truths[i] < kNoHit;
    missed += there && !hit;
    phantom += hit && !there;
    wrong += isWrong(shape, rays[i], truths[i], answers[i]);
    if (hit && there)
      errors.push_back(std::abs(answers[i] - truths[i]) / (std::nextafter(truths[i], kInfinity) - truths[i]));
  }
  std::sort(errors.begin(), errors.end());
  const double million = 1e6 / static_cast<double>(rays.size());
  return {1e9 * best / static_cast<double>(timed),
          errors.empty() ? 0 : errors[errors.size() / 2],
          errors.empty() ? 0 : errors.back(),
          missed * million,
          phantom * million,
          wrong * million};
}

template <class S>
void compare(const char* name, const S& shape, const std::vector<Vec3>& edges, std::size_t count) {
  const std::vector<LocalRay> rays = raysAt(edges, count);
  std::vector<double> truths;
  for (const LocalRay& ray : rays) truths.push_back(truth(shape, ray));
  const auto print = [&](const char* which, const Measured& m) {
    std::printf("%s\t%s\t%.1f\t%.2f\t%.4g\t%zu\t%.0f\t%.0f\t%.0f\n", name, which, m.ns, m.typical, m.worst,
                rays.size(), m.missed, m.phantom, m.wrong);
  };
  print("ours", measure(shape, rays, truths, [&](const LocalRay& ray) { return shape.intersect(ray, 0); }));
  print("textbook", measure(shape, rays, truths, [&](const LocalRay& ray) { return textbook(shape, ray); }));
  std::fflush(stdout);
}

void compareAll(std::size_t rays) {
  const Vec3 tilted = normalize(Vec3{0.3, -0.5, 0.8});
  const std::vector<Vec3> star{{1, 0.1, 0}, {0.2, 0.3, 0},   {0, 1, 0},   {-0.3, 0.2, 0},
                               {-1, 0, 0},  {-0.2, -0.3, 0}, {0.1, -1, 0}};
  Polygon polygon{star, {0, 0, 1}};
  polygon.prepare();
  const Triangle triangle{{Vec3{-0.9, -0.5, 0.1}, Vec3{0.8, -0.6, 0.3}, Vec3{0.1, 0.9, -0.4}}};
  std::printf("kernel\tformula\tns\ttypical\tworst\trays\tmissed\tphantom\twrong\n");
  compare("sphere", Sphere{}, {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}, rays);
  compare("box", Box{{-0.7, -0.6, -0.5}, {0.7, 0.8, 0.6}},
          {{-0.7, -0.6, -0.5}, {0.7, -0.6, -0.5}, {0.7, 0.8, -0.5}, {0.7, 0.8, 0.6}}, rays);
  compare("plane", Plane{{0.1, 0.2, 0.3}, tilted}, {}, rays);
  compare("disc", Disc{{0, 0, 0}, tilted, 1}, {}, rays);
  compare("cylinder", Cylinder{*frustumBetween({0, 0, -0.8}, 0.7, {0.1, 0.3, 0.8}, 0.7)}, {}, rays);
  compare("cone", Cone{*frustumBetween({0, 0, 0.8}, 0, {0.1, 0.3, -0.8}, 0.7)},
          {{0, 0, 0.8}, {0.1, 0.3, -0.1}}, rays);
  compare("triangle", triangle, {triangle.corners.begin(), triangle.corners.end()}, rays);
  compare("polygon", polygon, star, rays);
  compare("torus", Torus{0.8, 0.25, {0, 0, 0}, {0, 0, 1}}, {}, rays / 10);
}

}  // namespace
}  // namespace rayshade

int main(int argc, char** argv) {
  const long rays = argc > 1 ? std::atol(argv[1]) : 1000000;
  rayshade::compareAll(static_cast<std::size_t>(std::clamp(rays, 1000L, 10000000L)));
}
