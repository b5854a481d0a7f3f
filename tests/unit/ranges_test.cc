// Numbers out of their ranges are refused where they stand; so many ways in a scene to leave the finite numbers.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "rayshade/base/range.h"
#include "rayshade/optics/refraction.h"
#include "tests/support/parsed_text.h"
#include "tests/support/traced_tile.h"

namespace rayshade {
namespace {

TEST(Range, HasItsEndsOrNot) {
  EXPECT_TRUE(kShare.holds(0) && kShare.holds(1) && !kShare.holds(-1e-300) && !kShare.holds(1.5));
  EXPECT_TRUE(!kFieldOfView.holds(0) && !kFieldOfView.holds(180) && kFieldOfView.holds(1e-300));
  EXPECT_TRUE(kAnyNumber.holds(-1e308) && kPositive.holds(1e308) && !kPositive.holds(0));
  EXPECT_FALSE(kAnyNumber.holds(std::nan("")));
}

TEST(Range, IsSaidInWords) {
  EXPECT_EQ(describe(kShare), "from 0 to 1");
  EXPECT_EQ(describe(kFieldOfView), "between 0 and 180");
  EXPECT_EQ(describe(kPositive), "above 0");
  EXPECT_EQ(describe(kNotNegative), "of at least 0");
}

TEST(Ranges, ArePlacedAtTheNumber) {
  EXPECT_EQ(errorOf("sphere diffuse 1 1 1\n extinct -1 1 0 0 0"),
            "s.ray:2:10: error: a number from 0 to 1 is expected here, not -1");
  EXPECT_EQ(errorOf("sample 65"), "s.ray:1:8: error: a whole number from 1 to 64 is expected here, not 65");
  EXPECT_EQ(errorOf("fov 40 (90 * 2)"),
            "s.ray:1:8: error: a number between 0 and 180 is expected here, not 180");
  EXPECT_EQ(errorOf("light 1 1e31 1 point 0 0 0"),
            "s.ray:1:9: error: a number from -1e+30 to 1e+30 is expected here, not 1e+31");
  EXPECT_EQ(errorOf("atmosphere 0"), "s.ray:1:12: error: a number above 0 is expected here, not 0");
}

TEST(Ranges, OfWholeNumbersAreAskedWhenTheyAreCut) {
  EXPECT_EQ(good("sample 8.9")->head.picture.samplesPerSide, 8);
  EXPECT_NE(errorOf("sample 0.9"), "");
}

TEST(Ranges, OfAFractalConcernItsStrength) {
  EXPECT_EQ(
      errorOf("sphere 1 0 0 0 texture fbm 0 1 -9 2 5 0"),
      "s.ray:1:24: error: each octave of this fractal is more than 10 times as strong as the one before");
}

TEST(PhongLobe, IsBoundedForNormalsThatAreNotUnit) {
  EXPECT_EQ(phongLobe(0.5, 2), 0.25);
  EXPECT_EQ(phongLobe(1e9, 1e9), 1e30);
}

TEST(Sampler, CountsColoursThatAreNoNumbersAndMakesThemBlack) {
  PictureSpec spec;
  spec.width = spec.height = 1;
  spec.samplesPerSide = 1;
  Sampler sampler(spec, 1, 0);
  supplyNext(sampler, [](const SampleId&) { return Color{std::nan(""), 1, HUGE_VAL}; });
  std::vector<Color> row;
  ASSERT_TRUE(sampler.takeRow(row));
  EXPECT_EQ(row.at(0), kBlack);
  EXPECT_EQ(sampler.counts().notFinite, 1u);
}

}  // namespace
}  // namespace rayshade
