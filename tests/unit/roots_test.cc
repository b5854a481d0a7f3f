// Roots with exactly known answers: many decades, clusters, multiple roots, and polynomials without any.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/roots.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rayshade {
namespace {

Quartic fromRoots(double a, double b, double c, double d) {
  const long double p = a, q = b, r = c, s = d;
  return {static_cast<double>(p * q * r * s), static_cast<double>(-(p * q * (r + s) + r * s * (p + q))),
          static_cast<double>(p * q + r * s + (p + q) * (r + s)), static_cast<double>(-(p + q + r + s)), 1};
}

TEST(Roots, NineDecadesApartAreAllExact) {
  const Roots roots = rootsBetween(fromRoots(1e-3, 1, 1e3, 1e6), 0, 2e6);
  ASSERT_EQ(roots.count, 4u);
  const double expected[] = {1e-3, 1, 1e3, 1e6};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(roots.at[i], expected[i], 1e-12 * expected[i]);
}

TEST(Roots, ClusterOfTwoIsNotMerged) {
  const Roots roots = rootsBetween(fromRoots(1, 1 + 1e-6, 2, 3), 0, 4);
  ASSERT_EQ(roots.count, 4u);
  EXPECT_NEAR(roots.at[0], 1, 1e-9);
  EXPECT_NEAR(roots.at[1], 1 + 1e-6, 1e-8);  // its slope is 2e-6: rounding moves it this far
  EXPECT_NEAR(roots.at[2], 2, 1e-14);
  EXPECT_NEAR(roots.at[3], 3, 1e-14);
}

TEST(Roots, FourfoldRootIsGivenOnce) {
  const Roots roots = rootsBetween(fromRoots(1, 1, 1, 1), -3, 8);
  ASSERT_EQ(roots.count, 1u);
  EXPECT_NEAR(roots.at[0], 1, 1e-4);
}

TEST(Roots, TripleRootIsGivenOnce) {
  const Roots roots = rootsBetween(fromRoots(1, 1, 1, 5), -3, 8);
  ASSERT_EQ(roots.count, 2u);
  EXPECT_NEAR(roots.at[0], 1, 1e-5);
  EXPECT_NEAR(roots.at[1], 5, 1e-14);
}

TEST(Roots, TwoDoubleRootsAreGivenOnceEach) {
  const Roots roots = rootsBetween(fromRoots(1, 1, 3, 3), -3, 8);
  ASSERT_EQ(roots.count, 2u);
  EXPECT_NEAR(roots.at[0], 1, 1e-8);
  EXPECT_NEAR(roots.at[1], 3, 1e-8);
}

TEST(Roots, NoPhantomsOfAPolynomialThatIsNeverZero) {
  EXPECT_EQ(rootsBetween(Quartic{1e-12, 0, 1 + 1e-12, 0, 1}, -10, 10).count, 0u);  // (x^2+1e-12)(x^2+1)
  EXPECT_EQ(rootsBetween(Quartic{1, 0, 0, 0, 1}, -10, 10).count, 0u);
  EXPECT_EQ(rootsBetween(Quartic{}, -10, 10).count, 0u);
}

TEST(Roots, QuarticThatAClosedFormLost) {
  const Quartic quartic{26471900.25, -1325880, 25449, -240, 1};
  const Roots roots = rootsBetween(quartic, 0, 120);
  ASSERT_EQ(roots.count, 2u);
  EXPECT_NEAR(roots.at[0], 50.645112696944665, 1e-10);
  EXPECT_NEAR(roots.at[1], 69.35488730305534, 1e-10);
}

TEST(Roots, OnlyThoseInsideOfTheInterval) {
  const Quartic quartic = fromRoots(1, 2, 3, 4);
  const Roots roots = rootsBetween(quartic, 1.5, 3.5);
  ASSERT_EQ(roots.count, 2u);
  EXPECT_NEAR(roots.at[0], 2, 1e-14);
  EXPECT_NEAR(roots.at[1], 3, 1e-14);
  EXPECT_EQ(rootsBetween(quartic, 4.5, 9).count, 0u);
}

TEST(Roots, ExactEndsBelongToTheInterval) {
  const Roots roots = rootsBetween(fromRoots(1, 2, 3, 4), 1, 2);
  ASSERT_EQ(roots.count, 2u);
  EXPECT_EQ(roots.at[0], 1);
  EXPECT_EQ(roots.at[1], 2);
}

TEST(Roots, QuarticOfLowerDegree) {
  const Roots quadratic = rootsBetween(Quartic{-2, 0, 1, 0, 0}, -5, 5);
  ASSERT_EQ(quadratic.count, 2u);
  EXPECT_DOUBLE_EQ(quadratic.at[0], -std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(quadratic.at[1], std::sqrt(2.0));
  const Roots linear = rootsBetween(Quartic{-3, 2, 0, 0, 0}, -5, 5);
  ASSERT_EQ(linear.count, 1u);
  EXPECT_DOUBLE_EQ(linear.at[0], 1.5);
}

TEST(Roots, CubicWithThreeAndWithOne) {
  const Roots three = rootsBetween(Cubic{-6, 11, -6, 1}, 0, 10);
  ASSERT_EQ(three.count, 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(three.at[i], static_cast<double>(i + 1), 1e-14);
  const Roots one = rootsBetween(Cubic{-8, 0, 0, 1}, -10, 10);
  ASSERT_EQ(one.count, 1u);
  EXPECT_DOUBLE_EQ(one.at[0], 2);
}

TEST(Roots, ScalingByPowersOfTwoKeepsTheBits) {
  const Quartic quartic = fromRoots(0.3, 0.7, 1.9, 2.2);
  const Roots plain = rootsBetween(quartic, 0, 4);
  ASSERT_EQ(plain.count, 4u);
  for (const int power : {-20, 13}) {
    Quartic stretched = quartic, louder = quartic;
    for (int i = 0; i < 5; ++i) {
      const auto k = static_cast<std::size_t>(i);
      stretched[k] = std::ldexp(quartic[k], -power * i);  // roots times 2^power
      louder[k] = std::ldexp(quartic[k], 25 * power);     // and far enough to leave the usual range
    }
    const Roots wide = rootsBetween(stretched, 0, std::ldexp(4, power));
    const Roots loud = rootsBetween(louder, 0, 4);
    ASSERT_EQ(wide.count, 4u);
    ASSERT_EQ(loud.count, 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(wide.at[i], std::ldexp(plain.at[i], power));
      EXPECT_EQ(loud.at[i], plain.at[i]);
    }
  }
}

TEST(Roots, BadNumbersHaveNoRoots) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(rootsBetween(Quartic{-1, nan, 0, 0, 1}, -2, 2).count, 0u);
  EXPECT_EQ(rootsBetween(Quartic{-1, 0, inf, 0, 1}, -2, 2).count, 0u);
  EXPECT_EQ(rootsBetween(Quartic{nan, nan, nan, nan, nan}, -2, 2).count, 0u);
}

}  // namespace
}  // namespace rayshade
