// The outline of a polygon answers as the exact test of all corners does.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shapes/outline.h"

#include <gtest/gtest.h>

#include <numbers>

#include "rayshade/shapes/polygon.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

// Gears, stars, needles and outlines that cross themselves, in any plane, a little off it or far away.
Polygon somePolygon(Random& random) {
  const int corners = random.integer(9, 168);
  const double scale = std::ldexp(1.0, random.integer(-40, 40));
  const Vec3 normal = random.direction();
  const Basis basis = basisAround(normal);
  const Vec3 centre = random.chance(0.5) ? random.point(-100, 100) : Vec3{};
  const double flat = random.chance(0.25) ? std::ldexp(1.0, -random.integer(2, 45)) : 1;
  const double wobble = random.chance(0.25) ? 1e-6 : 0, ragged = random.real(-1, 1),
               turns = random.chance(0.25) ? 2 : 1;
  Polygon polygon;
  polygon.corners.clear();
  for (int i = 0; i < corners; ++i) {
    const double angle = turns * 2 * std::numbers::pi * i / corners;
    const double radius = ragged > 0.3    ? 1 + 0.8 * random.real(-1, 1)
                          : ragged > -0.3 ? (i & 2 ? 0.8 : 1.0)
                                          : 1.0;
    const Vec3 corner = centre +
                        radius * (std::cos(angle) * basis.first + flat * std::sin(angle) * basis.second) +
                        wobble * random.real(-1, 1) * normal;
    polygon.corners.push_back(corner * scale);
  }
  polygon.normal = normal;
  polygon.prepare();
  return polygon;
}

TEST(Outline, AnswersAsTheExactTestDoes) {
  SeededRandom random(7);
  int hits = 0, unsure = 0, asked = 0;
  for (int scene = 0; scene < 300; ++scene) {
    const Polygon polygon = somePolygon(random);
    ASSERT_NE(polygon.outline, nullptr);
    Polygon slow = polygon;
    slow.outline = nullptr;
    const double size = maxAbs(polygon.bounds().size());
    for (int i = 0; i < 200; ++i) {
      const auto pick = [&] { return random.pick(polygon.corners); };
      // A third at points of the plane, a third at corners, a third at edges.
      Vec3 target = pick() * 0.3 + pick() * 0.3 + pick() * 0.4;
      if (i % 3 == 1) target = pick();
      if (i % 3 == 2) target = polygon.corners[0] * 0.25 + polygon.corners[1] * 0.75;
      const double steepness = i % 5 == 0 ? 1e-6 : 1;
      const Vec3 away = random.point(-1, 1);
      const Vec3 from = target + (polygon.normal * (steepness * random.real(-1, 1)) + away) *
                                     (size * (i % 7 == 0 ? 1e5 : 1));
      const LocalRay ray{from, normalize(target - from), 1};
      const double t = polygon.intersect(ray, 0);
      ASSERT_EQ(t, slow.intersect(ray, 0)) << "scene " << scene << " ray " << i;
      if (t < kNoHit) {
        EXPECT_EQ(polygon.intersect(ray, 0, t), t);
        EXPECT_EQ(polygon.intersect(ray, 0, std::nextafter(t, 0.0)), kNoHit);
      }
      hits += t < kNoHit;
      ++asked;
      unsure += !polygon.outline->windsAround(
          polygon.corners, ray,
          dot(polygon.normal, polygon.corners[0] - from) / dot(polygon.normal, ray.direction));
    }
  }
  EXPECT_GT(hits, asked / 5);
  EXPECT_LT(hits, asked * 4 / 5);
  EXPECT_LT(unsure, asked * 3 / 4);  // two thirds are aimed at the outline itself
}

TEST(Outline, SaysNothingWhenCornersAreNotNumbers) {
  const double nan = std::nan("");
  std::vector<Vec3> corners(20, Vec3{1, 1, 0});
  corners[7] = {nan, 2, 0};
  EXPECT_FALSE(Outline(corners, {0, 0, 1}).windsAround(corners, {{0, 0, 1}, {0, 0, -1}, 1}, 1).has_value());
  corners[7] = {kInfinity, 2, 0};
  EXPECT_FALSE(Outline(corners, {0, 0, 1}).windsAround(corners, {{0, 0, 1}, {0, 0, -1}, 1}, 1).has_value());
}

TEST(Outline, OfManyLongEdgesStaysSmall) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 20000; ++i) corners.push_back({i * 1e-4, i & 1 ? 1.0 : 0.0, 0});
  const Outline outline(corners, {0, 0, 1});
  EXPECT_LT(outline.bytes(), corners.size() * 40);
}

}  // namespace
}  // namespace rayshade
