// Statements about the whole picture.
// guarded: reads text of others
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "rayshade/language/viewing.h"
#include "tests/support/parsed_text.h"

namespace rayshade {
namespace {

TEST(Parser, StartsFromTheDefaultsOfRayshade) {
  const auto s = good("sphere 1 0 0 0");
  EXPECT_EQ(s->head.camera.eye, (Vec3{0, -10, 0}));
  EXPECT_EQ(s->head.picture.width, 512);
  EXPECT_EQ(s->head.settings.limits.maxDepth, 5);
  ASSERT_EQ(s->head.settings.lights.size(), 1u);  // without lights: one from (1, -1, 1)
  const auto& light = std::get<DirectionalLight>(s->head.settings.lights[0].kind);
  EXPECT_NEAR(light.toward.x, std::sqrt(1. / 3), 1e-15);
  EXPECT_NEAR(light.toward.y, -std::sqrt(1. / 3), 1e-15);
  EXPECT_EQ(s->head.settings.ambient, kWhite);
}

TEST(Parser, ReadsTheViewingStatements) {
  const auto s = good(
      "eyep 1 2 3 lookp 4 5 6 up 0 1 0 fov 30 20 screen 320 200 window 1 2 3 4 crop .9 .1 -1 2 aperture .5 "
      "focaldist 7 "
      "eyesep .25 sample 4 nojitter filter gauss contrast .1 .2 .3 cutoff .5 maxdepth -3 background .7 .8 .9 "
      "outfile dir/out.png frames 3 framelength .5 starttime 2 shutter .1 shadowtransp");
  const SceneHead& h = s->head;
  EXPECT_EQ(h.camera.eye, (Vec3{1, 2, 3}));
  EXPECT_EQ(h.camera.target, (Vec3{4, 5, 6}));
  EXPECT_EQ(h.camera.up, (Vec3{0, 1, 0}));
  EXPECT_EQ(h.camera.horizontalFov, 30);
  EXPECT_EQ(h.camera.verticalFov, 20);
  EXPECT_EQ(h.camera.aperture, .5);
  EXPECT_EQ(h.camera.focalDistance, 7);
  EXPECT_EQ(h.camera.eyeSeparation, .25);
  EXPECT_EQ(h.picture.width, 320);
  EXPECT_EQ(h.picture.height, 200);
  EXPECT_EQ(h.picture.window, (std::array<std::int32_t, 4>{1, 2, 3, 4}));
  EXPECT_EQ(h.picture.crop, (std::array<double, 4>{.1, .9, 0, 1}));
  EXPECT_EQ(h.picture.samplesPerSide, 4);
  EXPECT_FALSE(h.picture.jitter);
  EXPECT_TRUE(h.picture.filter.gaussian);
  EXPECT_EQ(h.picture.filter.width, 1.8);
  EXPECT_EQ(h.picture.contrast, (Color{.1, .2, .3}));
  EXPECT_EQ(h.settings.limits.cutoff, (Color{.5, .5, .5}));
  EXPECT_EQ(h.settings.limits.maxDepth, 0);
  EXPECT_EQ(h.settings.background, (Color{.7, .8, .9}));
  EXPECT_EQ(h.outputFile, "dir/out.png");
  EXPECT_EQ(h.picture.frames, 3);
  EXPECT_EQ(h.picture.frameLength, .5);
  EXPECT_EQ(h.picture.startTime, 2);
  EXPECT_EQ(h.picture.shutter, .1);
  EXPECT_FALSE(h.settings.transparentShadows);
}

TEST(Parser, LetsLaterStatementsOverrideEarlierOnes) {
  const auto s = good(
      "fov 30 20 fov 50 filter gauss filter box 3 cutoff 1 2 3 resolution 10.9 20 shadowtransp shadowtransp "
      "outfile a outfile b eyep 1 2 3 rotate 0 0 1 90");
  EXPECT_EQ(s->head.camera.horizontalFov, 50);
  EXPECT_FALSE(s->head.camera.verticalFov.has_value());
  EXPECT_FALSE(s->head.picture.filter.gaussian);
  EXPECT_EQ(s->head.picture.filter.width, 3);
  EXPECT_EQ(s->head.settings.limits.cutoff, (Color{1, 2, 3}));
  EXPECT_EQ(s->head.picture.width, 10);
  EXPECT_TRUE(s->head.settings.transparentShadows);
  EXPECT_EQ(s->head.outputFile, "a");
  EXPECT_EQ(s->head.camera.eye, (Vec3{1, 2, 3}));
  EXPECT_EQ(s->warnings.size(), 2u);
}

TEST(Parser, ReadsReports) {
  auto report = [](const std::string& text) { return good("report " + text + " screen 3 3")->head.report; };
  EXPECT_TRUE(report("").wanted);
  EXPECT_EQ(report("").everyRows, 10);
  EXPECT_TRUE(report("verbose quiet 5 log.txt").verbose);
  EXPECT_TRUE(report("verbose quiet 5 log.txt").quiet);
  EXPECT_EQ(report("verbose quiet 5 log.txt").everyRows, 5);
  EXPECT_EQ(report("verbose quiet 5 log.txt").file, "log.txt");
  EXPECT_EQ(report("log").file, "log");
  EXPECT_NE(errorOf("report 0"), "");
}

TEST(Parser, KeepsLightsInTheirOrder) {
  const auto s = good(
      "light .5 ambient light 1 point 0 0 1 light 1 2 3 directional 0 0 2 noshadow light (1 - .5) extended "
      ".5 0 0 1 "
      "light 1 area 0 0 5 1 0 5 4 0 1 5 4 light 1 spot 0 0 5 0 0 0 1 20 30 noshadow light .1 .2 .3 ambient");
  const auto& lights = s->head.settings.lights;
  ASSERT_EQ(lights.size(), 5u);
  EXPECT_TRUE(std::holds_alternative<PointLight>(lights[0].kind));
  EXPECT_EQ(lights[1].color, (Color{1, 2, 3}));
  EXPECT_FALSE(lights[1].castsShadows);
  EXPECT_EQ(lights[2].color, (Color{.5, .5, .5}));
  EXPECT_TRUE(lights[3].castsShadows);
  EXPECT_FALSE(lights[4].castsShadows);
  EXPECT_EQ(s->head.settings.ambient, (Color{.1, .2, .3}));
}

TEST(Parser, SaysWhatIsWrongWithALight) {
  EXPECT_TRUE(errorOf("\nlight 1 directional 0 0 0").starts_with("s.ray:2:9: error: a directional light"));
  EXPECT_TRUE(errorOf("light 1 area 0 0 0 1 0 0 0 0 1 0 1").starts_with("s.ray:1:26: error: a whole number"));
  EXPECT_EQ(errorOf("light 1 sun 0 0 0"), "s.ray:1:9: error: a kind of light is expected here, not `sun`");
}

TEST(Parser, ReadsTheAtmosphere) {
  const auto s = good("atmosphere 1.5 fog 1 1 1 2 2 2 mist 1 1 1 2 2 2 0 1");
  EXPECT_EQ(s->head.settings.airIndex, 1.5);
  EXPECT_EQ(s->head.settings.atmosphere.size(), 2u);
  EXPECT_EQ(good("atmosphere fog 1 1 1 2 2 2 atmosphere 2")->head.settings.atmosphere.size(), 0u);
  EXPECT_NE(errorOf("atmosphere 0"), "");
}

TEST(Parser, PrintsValues) {
  EXPECT_EQ(good("define e (10 / 3) print (e * 3) print 5 print (-2 + 3 - -4)")->printed,
            (std::vector<std::string>{"10.000000", "5.000000", "5.000000"}));
}

std::string headError(const SceneHead& head) {
  try {
    checkHead(head, "s.ray");
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}
std::string headError(const std::string& text) { return headError(good(text)->head); }

TEST(Parser, ChecksTheHeadAtTheEnd) {
  EXPECT_EQ(headError(""), "");
  EXPECT_EQ(headError("up 0 8 -1 eyep 0 -8 1"), "s.ray:1:11: error: the direction of view is parallel to up");
  EXPECT_NE(headError("eyep 0 0 0").find("the same point"), std::string::npos);
  EXPECT_NE(headError("screen 100 100 window 0 100 0 99").find("window"), std::string::npos);
  EXPECT_EQ(headError("screen 100 100 window 0 99 0 99"), "");
  EXPECT_NE(headError("screen 10 65536 fov 40").find("fov"), std::string::npos);  // the vertical one
}

TEST(Parser, ChecksWhatTheCommandLineMayHaveChanged) {
  auto errorAfter = [](auto change) {
    SceneHead head = good("")->head;
    change(head.picture);
    return headError(head);
  };
  EXPECT_NE(errorAfter([](PictureSpec& p) { p.samplesPerSide = 65; }).find("sample count of 65"),
            std::string::npos);
  EXPECT_NE(errorAfter([](PictureSpec& p) { p.width = 0; }).find("screen"), std::string::npos);
  EXPECT_NE(errorAfter([](PictureSpec& p) { p.height = 1'000'000'000; }).find("screen"), std::string::npos);
  EXPECT_NE(errorAfter([](PictureSpec& p) { p.frames = 0; }).find("frames"), std::string::npos);
}

// The last of the statements that contradict each other.
TEST(Parser, SaysWhereTheHeadIsWrong) {
  EXPECT_EQ(errorOf("sample 2\n\n sample 65\nsphere 1 0 0 0\n").substr(0, 18), "s.ray:3:9: error: ");
  EXPECT_EQ(headError("lookp 1 2 3\neyep 4 5 6\n eyep 1 2 3\nfov 40").substr(0, 18), "s.ray:3:2: error: ");
  EXPECT_EQ(headError("eyep 1 2 3\nscreen 9 9\nlookp 1 2 3").substr(0, 18), "s.ray:3:1: error: ");
  EXPECT_EQ(headError("screen 100 100\nwindow 0 100 0 99").substr(0, 18), "s.ray:2:1: error: ");
  EXPECT_EQ(headError("frames 2000000").substr(0, 18), "s.ray:1:1: error: ");
  EXPECT_EQ(errorOf("\nfilter gauss -1").substr(0, 19), "s.ray:2:14: error: ");
}

TEST(Parser, ChecksStereoPictures) {
  SceneHead head = good("")->head;
  head.camera.eyeShown = Camera::Eye::left;
  EXPECT_THROW(checkHead(head, "s.ray"), SceneError);
  head.camera.eyeSeparation = 1;
  EXPECT_NO_THROW(checkHead(head, "s.ray"));
}

}  // namespace
}  // namespace rayshade
