// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/noise.h"

#include <gtest/gtest.h>

#include <limits>

namespace rayshade {
namespace {

constexpr double kLastDigit = 1e-14;

TEST(Noise, OriginHasTheExactValueOfTheOriginal) {
  EXPECT_EQ(noise({0, 0, 0}), -0.0339202880859375);
  EXPECT_EQ(vectorNoise({0, 0, 0}), (Vec3{-0.0339202880859375, -0.0859375, 0.423065185546875}));
}

TEST(Noise, CentreOfACubeHasTheExactValueOfTheOriginal) {
  EXPECT_EQ(noise({.5, .5, .5}), 0.2163848876953125);
}

TEST(Noise, FractionsAndNegativeCoordinatesAgreeWithTheOriginal) {
  EXPECT_NEAR(noise({1.25, -3.7, 8.125}), -0.018484367865102, kLastDigit);
  EXPECT_NEAR(noise({-12.3, 45.6, -78.9}), 0.135499314408905, kLastDigit);
  EXPECT_NEAR(noise({1000.1, 2000.2, -3000.3}), 0.24452078342567, kLastDigit);
}

TEST(Noise, ChaosAgreesWithTheOriginal) {
  EXPECT_NEAR(chaos({.5, .5, .5}, 6), 0.314282894134521, kLastDigit);
  EXPECT_NEAR(absoluteChaos({.5, .5, .5}, 6), 0.335067272186279, kLastDigit);
}

TEST(Noise, ScalarIsTheFirstComponentOfTheVector) {
  for (int i = 0; i < 100; ++i) {
    const Vec3 p{i * 0.37 - 9, i * -1.21, i * 5.77};
    EXPECT_EQ(noise(p), vectorNoise(p).x);
  }
}

TEST(Noise, RepeatsAfterThePeriod) {
  EXPECT_EQ(noise({1.25, 2.5, 3.75}), noise({1.25 + 4096, 2.5 - 4096, 3.75 + 8192}));
}

TEST(Noise, GoesOnBelowTheShiftOfTheOriginal) {
  const double far = -4096.0 * 300;  // beyond -1e6
  EXPECT_EQ(noise({1.25, 2.5, 3.75}), noise({1.25 + far, 2.5 + far, 3.75 + far}));
}

TEST(Noise, IsContinuousAcrossLatticePlanes) {
  for (int i = -3; i <= 3; ++i)
    EXPECT_NEAR(noise({i - 1e-9, 0.3, 0.7}), noise({i + 1e-9, 0.3, 0.7}), 1e-7) << "plane " << i;
}

TEST(Noise, IsFiniteEverywhere) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (double far :
       {1e15, -1e18, 1e19, -1e300, infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_TRUE(std::isfinite(noise({far, 0.5, 0.5}))) << far;
    EXPECT_TRUE(isFinite(vectorNoise({0.5, far, far}))) << far;
    EXPECT_TRUE(std::isfinite(chaos({0.5, far, far}, 2000000000))) << far;
  }
}

TEST(Noise, StatisticsAreThoseOfTheOriginal) {
  double sum = 0, squares = 0;
  constexpr int kSide = 40;
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const double n = noise({i % kSide * 0.71, i / kSide % kSide * 0.73, i / kSide / kSide * 0.77});
    ASSERT_LT(std::abs(n), 1.11);
    sum += n;
    squares += n * n;
  }
  const double count = kSide * kSide * kSide;
  EXPECT_NEAR(sum / count, 0, 0.02);
  EXPECT_NEAR(std::sqrt(squares / count), 0.254, 0.02);
}

TEST(FractionalMotion, OneOctaveIsTheNoiseItself) {
  const Vec3 p{1.25, -3.7, 8.125};
  EXPECT_EQ(fractionalMotion(p, fractionalSpectrum(0.5, 2, 1)), noise(p));
  EXPECT_EQ(vectorFractionalMotion(p, fractionalSpectrum(0.5, 2, 1)), vectorNoise(p));
}

TEST(FractionalMotion, OfHalfAndTwoHasHalvingAmplitudesAndDoublingFrequencies) {
  const Vec3 p{0.3, 0.4, -0.7};
  EXPECT_DOUBLE_EQ(fractionalMotion(p, fractionalSpectrum(0.5, 2, 6)), chaos(p, 6));
}

TEST(FractionalMotion, AmplitudeFollowsTheExponent) {
  EXPECT_DOUBLE_EQ(fractionalSpectrum(1, 2, 1).omega, std::pow(2, -1.5));
  EXPECT_DOUBLE_EQ(fractionalSpectrum(0, 4, 1).omega, 0.5);
}

TEST(FractionalMotion, NoOctavesAreZeroAndTooManyEnd) {
  const Vec3 p{0.3, 0.4, -0.7};
  EXPECT_EQ(fractionalMotion(p, fractionalSpectrum(0.5, 2, 0)), 0);
  EXPECT_EQ(fractionalMotion(p, fractionalSpectrum(0.5, 2, -3)), 0);
  const Spectrum endless = fractionalSpectrum(0.5, 2, 2147483647);
  EXPECT_NEAR(fractionalMotion(p, endless), chaos(p, 40), 1e-9);
  EXPECT_TRUE(isFinite(vectorFractionalMotion(p, endless)));
}

}  // namespace
}  // namespace rayshade
