// Mirrors and glass against angles that are known exactly.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/optics/refraction.h"

#include <gtest/gtest.h>

#include <numbers>

#include "rayshade/shapes/sphere.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr Vec3 kUp{0, 0, 1};

// Comes down to the plane z = 0 at an angle to its normal.
Vec3 fallingAt(long double radians) {
  return {static_cast<double>(std::sin(radians)), 0, static_cast<double>(-std::cos(radians))};
}
double angleTo(Vec3 a, Vec3 b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

TEST(Mirror, AnglesOfIncidenceAndReflectionAreEqual) {
  EXPECT_EQ(mirrored({3, 4, -5}, kUp), (Vec3{3, 4, 5}));
  EXPECT_EQ(mirrored({0, 0, -1}, kUp), kUp);
  EXPECT_EQ(mirrored({1, 0, 0}, kUp), (Vec3{1, 0, 0}));
}

TEST(Mirror, TheSideThatTheNormalPointsToDoesNotMatterAndTwiceIsBack) {
  SeededRandom random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 d = random.direction(), n = random.direction();
    EXPECT_EQ(mirrored(d, n), mirrored(d, -n));
    EXPECT_LT(length(mirrored(mirrored(d, n), n) - d), 3e-15);
  }
}

TEST(Mirror, AThousandBouncesInATiltedBoxKeepTheLength) {
  SeededRandom random(1);
  for (int box = 0; box < 20; ++box) {
    const Vec3 floor = random.direction();
    const auto [wall, end] = basisAround(floor);
    const Vec3 normals[] = {floor, wall, end, -floor, -wall, -end};
    Vec3 d = random.direction();
    for (int bounce = 0; bounce < 1000; ++bounce)
      d = mirrored(d, normals[static_cast<int>(random.real(0, 6))]);
    EXPECT_LT(std::abs(length(d) - 1), 1e-12);
  }
}

TEST(Glass, AWindowBetweenEqualMediaBendsNothing) {
  SeededRandom random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 d = random.direction();
    const Vec3 n = dot(d, kUp) < 0 ? kUp : -kUp;
    const auto through = refracted(d, n, 1.5, 1.5);
    ASSERT_TRUE(through);
    EXPECT_LT(length(*through - d), 1e-15 / std::abs(d.z));
  }
}

TEST(Glass, SnellsLawHolds) {
  for (double degrees = 0; degrees < 90; degrees += 0.5) {
    const auto inside = refracted(fallingAt(degrees * kDegree), kUp, 1, 1.5);
    ASSERT_TRUE(inside);
    EXPECT_NEAR(length(*inside), 1, 1e-15);
    EXPECT_NEAR(inside->x, std::sin(degrees * kDegree) / 1.5, 1e-15);
    EXPECT_EQ(inside->y, 0);
    EXPECT_LT(inside->z, 0);
  }
}

TEST(Glass, TheWayBackIsTheSame) {
  SeededRandom random(1);
  for (int i = 0; i < 1000; ++i) {
    Vec3 d = random.direction();
    if (d.z > 0) d = -d;
    const double index = random.real(1, 3);
    const auto inside = refracted(d, kUp, 1, index);
    ASSERT_TRUE(inside);
    const auto back = refracted(-*inside, -kUp, index, 1);
    ASSERT_TRUE(back);
    EXPECT_LT(length(*back + d), 1e-14 / std::abs(d.z));
  }
}

TEST(Glass, TotalReflectionBeginsAtTheCriticalAngle) {
  const long double critical = std::asin(2.0L / 3.0L), little = 1e-12L * kDegree;
  const auto grazing = refracted(fallingAt(critical - little), kUp, 1.5, 1);
  ASSERT_TRUE(grazing);
  EXPECT_TRUE(isFinite(*grazing));
  // The cosine behind the surface grows like the square root of what is left to the critical angle.
  EXPECT_NEAR(angleTo(*grazing, -kUp) / kDegree, 90, 2e-5);
  EXPECT_LT(grazing->z, 0);
  EXPECT_FALSE(refracted(fallingAt(critical + little), kUp, 1.5, 1));
}

TEST(Glass, AroundTheCriticalAngleNothingIsEverNotANumber) {
  double sine = 2.0 / 3.0;
  for (int i = 0; i < 20; ++i) sine = std::nextafter(sine, 0);
  for (int i = 0; i < 40; ++i) {
    const auto through = refracted({sine, 0, -std::sqrt((1 - sine) * (1 + sine))}, kUp, 1.5, 1);
    if (through) {
      EXPECT_TRUE(isFinite(*through));
      EXPECT_NEAR(length(*through), 1, 1e-15);
    }
    sine = std::nextafter(sine, 1);
  }
}

// Thickness 1, index 1.5, 45 degrees: 0.32914230817732 sideways.
TEST(Glass, APlateShiftsARay) {
  const Vec3 in = fallingAt(45 * kDegree);
  const Vec3 inside = refracted(in, kUp, 1, 1.5).value();
  const Vec3 out = refracted(inside, kUp, 1.5, 1).value();
  EXPECT_LT(length(out - in), 1e-15);
  const Vec3 leaves = inside / -inside.z;
  EXPECT_NEAR(length(leaves - dot(leaves, in) * in), 0.32914230817732, 1e-13);
}

// A ray at height h along x through a ball of glass of radius 1; by how much it turns.
double deviationOfBall(double h) {
  const Sphere ball{{0, 0, 0}, 1};
  Vec3 at{-2, h, 0}, direction{1, 0, 0};
  const double enters = ball.intersect({at, direction, 1}, 0);
  at = at + enters * direction;
  direction = refracted(direction, normalize(at), 1, 1.5).value();
  const double leaves = ball.intersect({at, direction, 1}, 1e-6);
  at = at + leaves * direction;
  direction = refracted(direction, -normalize(at), 1.5, 1).value();
  return angleTo(direction, {1, 0, 0}) / kDegree;
}

TEST(Glass, ABallTurnsARayByTwiceTheDifferenceOfTheAngles) {
  EXPECT_NEAR(deviationOfBall(0), 0, 1e-14);
  EXPECT_NEAR(deviationOfBall(0.1), 3.833233495985, 1e-11);
  // Almost grazing: an error of the height is 700 times as large in the angle.
  EXPECT_NEAR(deviationOfBall(0.999999), 96.21741575179, 1e-9);
}

TEST(PhongLobe, IsThePowerOfTheCosineInFront) {
  EXPECT_EQ(phongLobe(1, 30), 1);
  EXPECT_DOUBLE_EQ(phongLobe(0.5, 3), 0.125);
  EXPECT_EQ(phongLobe(0, 3), 0);
  EXPECT_EQ(phongLobe(-0.5, 2), 0);
}

TEST(PhongLobe, WithoutAPowerThereIsNone) {
  EXPECT_EQ(phongLobe(1, 0), 0);
  EXPECT_EQ(phongLobe(0.9, -1), 0);
}

}  // namespace
}  // namespace rayshade
