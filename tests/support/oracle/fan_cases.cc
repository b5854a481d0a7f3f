// Fans of triangles without a leak.
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/oracle/exact_geometry.h"
#include "tests/support/oracle/hard_random.h"
#include "tests/support/oracle/verdict.h"

namespace rayshade {
namespace {

using exact::Exact;
using exact::Line;
using exact::Point;

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

}  // namespace

void examineFan(OracleReport& report, std::string_view name, std::uint64_t seed, std::uint64_t number) {
  HardRandom random(seed, number);
  const double size = random.size();
  const Vec3 middle = random.placeOf(size), axis = random.direction();
  const Basis across = basisAround(axis);
  std::vector<Vec3> ring;
  const int corners = 3 + random.below(6);
  for (int i = 0; i < corners; ++i) {
    const double turn = 6.283185307 * i / corners,
                 r = size * (random.oneIn(4) ? random.magnitude(1e-3, 1) : 1);
    ring.push_back(middle + r * (std::cos(turn) * across.first + std::sin(turn) * across.second +
                                 random.real(-0.3, 0.3) * axis));
  }
  std::vector<Triangle> fan;
  for (std::size_t i = 0; i < ring.size(); ++i)
    fan.push_back({{middle, ring[i], ring[(i + 1) % ring.size()]}});
  // At the vertex, a point of an inner edge, or one that is an ulp off.
  const Vec3 rim = ring[static_cast<std::size_t>(random.below(corners))];
  Vec3 target = middle + (random.oneIn(3) ? 0 : random.real()) * (rim - middle);
  if (random.oneIn(4)) target[random.below(3)] *= 1 + random.sign() * 2 * kUnit;
  const double distance =
      random.oneIn(2) ? size * random.magnitude(1e-1, 1e3) : random.magnitude(kLeast, kMost);
  const Vec3 toward = random.oneIn(4)   ? random.axis()
                      : random.oneIn(2) ? random.direction()
                                        : normalize(axis + 0.5 * random.direction());
  LocalRay ray{target - distance * toward, toward};
  if (random.oneIn(2) && target != ray.origin) ray.direction = normalize(target - ray.origin);

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

}  // namespace rayshade
