// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/oracle/aims.h"

#include "tests/support/oracle/exact_geometry.h"

namespace rayshade {

double make(HardRandom& random, Sphere& s) {
  s.radius = random.size();
  s.centre = random.placeOf(s.radius);
  return s.radius;
}
Spot spotOn(HardRandom& random, const Sphere& s) {
  const Vec3 n = random.axisOrNearly();
  return {s.centre + s.radius * n, n};
}

double make(HardRandom& random, Box& b) {
  const double size = random.size();
  const Vec3 place = random.placeOf(size);
  const auto side = [&] { return size * (random.oneIn(2) ? 1 : random.magnitude(1e-6, 1)); };
  do {
    b.low = place;
    b.high = place + Vec3{side(), side(), side()};
  } while (!(b.low.x < b.high.x && b.low.y < b.high.y && b.low.z < b.high.z));
  return size;
}
Spot spotOn(HardRandom& random, const Box& b) {  // on a face, often on an edge or a corner
  Spot spot;
  for (int axis = 0; axis < 3; ++axis) {
    const double share = random.share();
    spot.point[axis] = share == 0   ? b.low[axis]
                       : share == 1 ? b.high[axis]
                                    : b.low[axis] + share * (b.high[axis] - b.low[axis]);
  }
  const int face = random.below(3);
  const bool high = random.oneIn(2);
  spot.point[face] = high ? b.high[face] : b.low[face];
  spot.normal[face] = high ? 1 : -1;
  return spot;
}

double make(HardRandom& random, Plane& p) {
  p.point = random.placeOf(random.size());
  p.normal = random.axisOrNearly();
  return random.size();
}
Spot spotOn(HardRandom& random, const Plane& p) {
  return {p.point + (random.oneIn(4) ? 0 : random.size()) * random.across(p.normal), p.normal};
}

double make(HardRandom& random, Disc& d) {
  d.radius = random.size();
  d.centre = random.placeOf(d.radius);
  d.normal = random.axisOrNearly();
  return d.radius;
}
Spot spotOn(HardRandom& random, const Disc& d) {
  return {d.centre + random.share() * d.radius * random.across(d.normal), d.normal};
}

static double make(HardRandom& random, Frustum& f, bool cone) {
  for (;;) {
    const double size = random.size(), radius = size * (random.oneIn(2) ? 1 : random.magnitude(1e-4, 1));
    const double length = size * (random.oneIn(2) ? 1 : random.magnitude(1e-4, 1));
    const double other = !cone ? radius : random.oneIn(2) ? 0 : radius * random.real();
    const Vec3 base = random.placeOf(size);
    const auto made = frustumBetween(base, other, base + length * random.axisOrNearly(), radius);
    if (!made) continue;
    f = *made;
    return size;
  }
}
static Spot spotOn(HardRandom& random, const Frustum& f) {  // often at an end: the apex of a cone is one
  const double share = random.share();
  const Vec3 outward = random.across(f.axis);
  const Vec3 normal = normalize(f.length * outward - (f.endRadius - f.radius) * f.axis);
  return {f.base + share * f.length * f.axis + (f.radius + share * (f.endRadius - f.radius)) * outward,
          normal};
}
double make(HardRandom& random, Cylinder& c) { return make(random, c.side, false); }
double make(HardRandom& random, Cone& c) { return make(random, c.side, true); }
Spot spotOn(HardRandom& random, const Cylinder& c) { return spotOn(random, c.side); }
Spot spotOn(HardRandom& random, const Cone& c) { return spotOn(random, c.side); }

double make(HardRandom& random, Triangle& t) {
  for (;;) {
    const double size = random.size();
    const Vec3 place = random.placeOf(size);
    const bool needle = random.oneIn(4);
    const Vec3 along = random.direction();
    for (Vec3& corner : t.corners)
      corner = needle ? place + size * random.real(-1, 1) * along +
                            size * random.magnitude(1e-8, 1e-2) * random.direction()
                      : place + size * random.axisOrNearly();
    if (t.hasArea()) return size;
  }
}
Spot spotOn(HardRandom& random, const Triangle& t) {  // a corner, a point of an edge, or of the inside
  double b = random.share(), c = random.oneIn(2) ? 0 : random.real() * (1 - b);
  const int turn = random.below(3);
  const Vec3 from = t.corners[static_cast<std::size_t>(turn)];
  return {from + b * (t.corners[static_cast<std::size_t>((turn + 1) % 3)] - from) +
              c * (t.corners[static_cast<std::size_t>((turn + 2) % 3)] - from),
          t.normal()};
}
double make(HardRandom& random, PhongTriangle& t) {
  const double size = make(random, t.face);
  for (Vec3& n : t.normals) n = t.face.normal() + 0.4 * random.direction();
  return size;
}
double make(HardRandom& random, TriangleUv& t) { return make(random, t.phong); }
Spot spotOn(HardRandom& random, const PhongTriangle& t) { return spotOn(random, t.face); }
Spot spotOn(HardRandom& random, const TriangleUv& t) { return spotOn(random, t.phong.face); }

double make(HardRandom& random,
            Polygon& p) {  // a star around its centre, now and then one that crosses itself
  for (;;) {
    const double size = random.size();
    const Vec3 place = random.placeOf(size), normal = random.axisOrNearly();
    const Basis axes = basisAround(normal);
    const int corners = 3 + random.below(12);
    const int winds = random.oneIn(4) ? 2 : 1;
    const bool regular = random.oneIn(3);
    p = {};
    p.corners.clear();
    for (int i = 0; i < corners; ++i) {
      const double turn = 6.283185307179586 * winds * i / corners,
                   r = size * (regular ? 1 : random.real(0.2, 1));
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
Spot spotOn(HardRandom& random, const Polygon& p) {
  const std::size_t i = static_cast<std::size_t>(random.below(static_cast<int>(p.corners.size())));
  const Vec3 a = p.corners[i], b = p.corners[(i + 1) % p.corners.size()],
             c = p.corners[(i + 2) % p.corners.size()];
  return {a + random.share() * (b - a) + (random.oneIn(2) ? 0 : random.real() / 2) * (c - a), p.normal};
}

double make(HardRandom& random, Torus& t) {
  t.swept = random.size();
  t.tube = t.swept * random.magnitude(1e-4, 2);
  t.axis = random.axisOrNearly();
  t.centre = random.placeOf(t.swept + t.tube);
  return t.swept + t.tube;
}
Spot spotOn(HardRandom& random, const Torus& t) {
  const Vec3 axis = normalize(t.axis), outward = random.across(axis);
  const double turn = random.oneIn(3) ? random.below(4) * 1.5707963267948966 : random.real(0, 6.283185307);
  const Vec3 n = std::cos(turn) * outward + std::sin(turn) * axis;
  return {t.centre + t.swept * outward + t.tube * n, normalize(n)};
}

double make(HardRandom& random, Blob& b) {
  const double size = random.size();
  const Vec3 place = random.placeOf(size);
  b.balls.clear();
  double least = 1e300;
  for (int i = 1 + random.below(4); i > 0; --i) {
    const Vec3 at = b.balls.empty() ? place : place + size * random.real() * random.direction();
    b.balls.push_back({at, size * random.real(0.3, 1), random.real(0.5, 2)});
    least = std::min(least, b.balls.back().strength);
  }
  b.threshold = least * random.real(0.1, 0.9);
  return size;
}
Spot spotOn(HardRandom& random, const Blob& b) {
  const Metaball& ball = b.balls[static_cast<std::size_t>(random.below(static_cast<int>(b.balls.size())))];
  const Vec3 n = random.axisOrNearly();
  return {ball.centre + ball.radius * std::sqrt(1 - std::sqrt(b.threshold / ball.strength)) * n, n};
}

double make(HardRandom& random, HeightField& h) {
  const int size = 2 + random.below(5);
  const double steep = random.magnitude(1e-8, 900);
  std::vector<float> values;
  for (int i = 0; i < size * size; ++i) values.push_back(static_cast<float>(steep * random.real()));
  h.heights = makeHeights(size, std::move(values));
  return 1;
}
Spot spotOn(HardRandom& random, const HeightField& h) {
  const std::vector<Triangle> triangles = exact::partsOf(h);
  return spotOn(random,
                triangles[static_cast<std::size_t>(random.below(static_cast<int>(triangles.size())))]);
}

}  // namespace rayshade
