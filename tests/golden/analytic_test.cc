// Small scenes whose pixels are known without a renderer.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "rayshade/space/survey.h"
#include "tests/support/compare_pictures.h"
#include "tests/support/render_text.h"

namespace rayshade {
namespace {

// One ray, from the eye to the target: sample 1 nojitter takes the upper left corner of a cell whose centre is the
// corner of the pixel, so that in a 2 x 2 screen the pixel (1, 1) begins half a pixel off the line of sight.  With a field
// of view of nearly nothing the four rays are the line of sight.
Color colorSeen(const std::string& eye, const std::string& target, const std::string& scene) {
  const Rendered r = renderSequentially(
      jobOfText("screen 1 1 sample 1 nojitter fov 1e-7 1e-7 eyep " + eye + " lookp " + target + " " + scene));
  const std::vector<float>& p = r.frames.at(0).pixels;
  return {p[0], p[1], p[2]};
}

TEST(Analytic, APlaneFacingTheLightHasItsDiffuseColour) {
  const Color c = colorSeen(
      "0 0 5", "0 0 0", "up 0 1 0 light 1 directional 0 0 1 surface s diffuse .5 .25 1 plane s 0 0 0 0 0 1");
  EXPECT_NEAR(c.r, .5, 1e-6);
  EXPECT_NEAR(c.g, .25, 1e-6);
  EXPECT_NEAR(c.b, 1, 1e-6);
}

TEST(Analytic, TheCosineOfTheLight) {
  const Color c = colorSeen("0 0 5", "0 0 0",
                            "up 0 1 0 light 1 directional 0 1 1 surface s diffuse 1 1 1 plane s 0 0 0 0 0 1");
  EXPECT_NEAR(c.r, std::sqrt(.5), 1e-6);
}

TEST(Analytic, ANegativeDiffuseColourTakesLightAway) {
  const std::string scene =
      "up 0 1 0 light 1 directional 0 0 1 plane ambient .8 .8 .8 diffuse -.5 -.5 -.5 0 0 0 0 0 1";
  EXPECT_NEAR(colorSeen("0 0 5", "0 0 0", scene).r, .3, 1e-6);
}

TEST(Analytic, ALightInThePlaneLeavesItBlack) {
  const Rendered r =
      renderSequentially(jobOfText("screen 30 30 sample 1 nojitter eyep 3 -8 4 light 1 point 1 1 0 surface s "
                                   "diffuse 1 1 1 plane s 0 0 0 0 0 1"));
  for (float p : r.frames[0].pixels) EXPECT_EQ(p, 0.0f);
}

TEST(Analytic, AnOccluderAHairAboveTheFloorCastsItsShadow) {
  const std::string scene = "up 0 1 0 light 1 directional 0 1 1 surface s diffuse 1 1 1 plane s 0 0 0 0 0 1 ";
  EXPECT_GT(colorSeen("0 -.01 5", "0 -.01 0", scene).r, .5);
  EXPECT_EQ(colorSeen("0 -1e-8 5", "0 -1e-8 0", scene + "box s -1 0 1e-7 1 1 2").r, 0);
}

TEST(Analytic, AnOccluderAtTheDistanceOfTheLightCastsNone) {
  const std::string scene = "up 0 1 0 light 1 point 0 0 4 surface s diffuse 1 1 1 plane s 0 0 0 0 0 1 ";
  EXPECT_NEAR(colorSeen("10 0 5", "0 0 0", scene + "disc s 1 0 0 4 0 0 1").r, 1, 1e-6);
  EXPECT_EQ(colorSeen("3 0 5", "0 0 0", scene + "disc s 1 0 0 3.99 0 0 1").r, 0);
}

TEST(Analytic, AGlassSlabShiftsTheRay) {
  // Thickness 1, index 1.5, 45 degrees: sideways by 0.32914230817732, which is 0.32914.../cos 45 along the floor.
  const double shift = 0.32914230817732 * std::sqrt(2.0);
  const std::string glass =
      "up 0 1 0 light 1 ambient maxdepth 5 surface g transp 1 index 1.5 surface black ambient 0 0 0 surface "
      "white ambient 1 1 1 "
      "box g -50 -50 1 50 50 2 plane black 0 0 -10 0 0 1 ";
  // Without the slab the ray would meet z = 0 at x = 0; with it at x = -shift.  Narrow strips tell.
  auto sees = [&](double low, double high) {
    char strip[200];
    std::snprintf(strip, sizeof strip, "polygon white %.9g -1 0 %.9g -1 0 %.9g 1 0 %.9g 1 0", low, high, high,
                  low);
    return colorSeen("-10 0 10", "0 0 0", glass + strip).r > .5;
  };
  EXPECT_TRUE(sees(-shift - 1e-4, -shift + 1e-4));
  EXPECT_FALSE(sees(-shift + 1e-4, -shift + 3e-4));
  EXPECT_FALSE(sees(-shift - 3e-4, -shift - 1e-4));
}

TEST(Analytic, TotalReflectionBeginsAtTheCriticalAngle) {
  // From inside glass (index 1.5) onto its face z = 0: 41.8103148957786 degrees.
  auto sees = [](double degrees) {
    const double a = degrees * 3.14159265358979323846 / 180;
    char eye[96];
    std::snprintf(eye, sizeof eye, "%.17g 0 %.17g", -10 * std::sin(a), -10 * std::cos(a));
    return colorSeen(eye, "0 0 0",
                     "background 0 0 1 maxdepth 1 surface g transp 1 index 1.5 surface white ambient 1 0 0 "
                     "plane g 0 0 0 0 0 1 plane white 0 0 -50 0 0 1");
  };
  const Color below = sees(41.8), above = sees(41.82);
  EXPECT_EQ(below.r, 0) << "it leaves for the sky";
  EXPECT_NEAR(below.b, 1, 1e-6);
  EXPECT_NEAR(above.r, 1, 1e-6) << "it turns back to the wall";
  EXPECT_EQ(above.b, 0);
}

TEST(Analytic, TwoMirrorsReflectUntilTheCutoff) {
  // 0.9^58 = 0.0022185 is still traced, 0.9^59 = 0.0019967 is not: each of the hits 0..58 adds 0.9^k.
  const Color c = colorSeen("0 0 0", "0 0 1",
                            "up 0 1 0 cutoff .002 maxdepth 1000 light 1 ambient surface m ambient 1 1 1 "
                            "specular .9 .9 .9 reflect 1 "
                            "plane m 0 0 1 0 0 -1 plane m 0 0 -1 0 0 1");
  EXPECT_NEAR(c.r, (1 - std::pow(.9, 59)) / (1 - .9), 1e-4);
}

TEST(Analytic, ScenesScaledByAPowerOfTwoHaveTheSameBits) {
  auto scene = [](double k) {
    char text[1500];
    std::snprintf(text, sizeof text,
                  "screen 24 18 sample 1 nojitter maxdepth 4 eyep %.17g %.17g %.17g lookp 0 0 0 fov 40 light "
                  "1 point %.17g %.17g %.17g "
                  "surface g diffuse .1 .1 .1 transp .8 index 1.5 specular .5 .5 .5 specpow 9 reflect .4 "
                  "surface r ambient .1 .1 .1 "
                  "diffuse .7 .3 .2 sphere g %.17g 0 0 0 box r %.17g %.17g %.17g %.17g %.17g %.17g torus r "
                  "%.17g %.17g 0 0 0 1 0 1 "
                  "plane r 0 0 %.17g 0 0 1",
                  k, -6 * k, 2 * k, -3 * k, -4 * k, 5 * k, k, k, k, -k, 2 * k, 2 * k, k, 1.5 * k, .25 * k,
                  -k);
    return renderSequentially(jobOfText(text)).frames;
  };
  const auto one = scene(1);
  EXPECT_EQ(difference(scene(0x1p20), one), "");
  EXPECT_EQ(difference(scene(0x1p-20), one), "");
}

TEST(Analytic, ASolidWithoutItselfIsNothing) {
  const std::string scene = "background .5 .5 .5 surface s ambient 1 0 0 ";
  for (const std::string solid :
       {"sphere s 1 0 0 0 ", "box s -1 -1 -1 1 1 1 ", "torus s 1 .3 0 0 0 0 1 1 "}) {
    const Rendered r = renderSequentially(jobOfText("screen 40 30 sample 1 nojitter eyep 1 -5 2 " + scene +
                                                    "difference " + solid + solid + "end"));
    for (float p : r.frames[0].pixels) ASSERT_EQ(p, .5f) << solid;
  }
}

TEST(Analytic, FacesThatCoincideLeaveNoFilm) {
  // The half x > 0 is taken away from a box, with two faces in the same planes.
  const std::string scene =
      "background .5 .5 .5 light 1 ambient surface s ambient 1 0 0 difference box s -1 -1 -1 1 1 1 box s 0 "
      "-1 -1 2 1 1 end";
  EXPECT_EQ(colorSeen("-.5 -5 0", "-.5 0 0", scene).g, 0);
  EXPECT_NEAR(colorSeen(".5 -5 0", ".5 0 0", scene).g, .5, 1e-6);
  EXPECT_NEAR(colorSeen(".5 -5 2", ".5 0 0", scene).g, .5, 1e-6);
}

TEST(Analytic, ThinShellsOfGlassAreMetInOrder) {
  // Outer, inner, inner, outer: each crossing filters by 0.5.
  const Color c = colorSeen("0 -5 0", "0 0 0",
                            "background 1 1 1 cutoff 0 maxdepth 9 surface g transp .5 index 1 sphere g 1 0 0 "
                            "0 sphere g .9999999 0 0 0");
  EXPECT_NEAR(c.r, 1.0 / 16, 1e-6);
}

TEST(Analytic, AMatrixThatCannotBeInvertedIsAMessage) {
  SurveySink sink({});
  EXPECT_THROW(jobOfText("sphere 1 0 0 0 scale 1 0 1").read(sink), SceneError);
}

}  // namespace
}  // namespace rayshade
