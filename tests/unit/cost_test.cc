// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/cost.h"

#include <gtest/gtest.h>

#include "rayshade/space/survey.h"
#include "tests/support/random_scene.h"
#include "tests/support/render_text.h"

namespace rayshade {
namespace {

struct Predicted {
  std::vector<CostBox> costs;
  double within(const Bounds& part) const {
    double sum = 0;
    for (const CostBox& c : costs)
      if (contains(part, c.box.centre())) sum += c.cost;
    return sum;
  }
};

Predicted predict(const std::string& scene) {
  SurveySink sink({});
  const SceneHead head = jobOfText(scene).read(sink);
  const Survey survey = sink.survey();
  return {predictCost(survey.world, survey.sample, viewOf(head.camera, head.picture).value(), head.picture,
                      head.settings)};
}

// The eye looks along +x; nothing shines unless a test says so.
const std::string kEye = "screen 32 32 eyep -20 0 0 lookp 0 0 0 up 0 0 1 fov 40 ";
const std::string kDark = "light 1 point -20 0 0 noshadow ";

TEST(PredictCost, AWallHidesWhatIsBehindIt) {
  const std::string behind = "sphere diffuse 1 1 1 3 10 0 0 ";
  const Bounds there{{6, -4, -4}, {14, 4, 4}};
  const double seen = predict(kEye + kDark + behind + "box diffuse 1 1 1 0 -9 -9 1 9 -8.5").within(there);
  const double hidden = predict(kEye + kDark + behind + "box diffuse 1 1 1 0 -9 -9 1 9 9").within(there);
  EXPECT_GT(seen, 100);
  EXPECT_LT(hidden, 0.5 * seen);
}

TEST(PredictCost, WhatIsBesideThePictureCostsNothing) {
  const Predicted p =
      predict(kEye + kDark +
              "sphere diffuse 1 1 1 1 0 0 0 sphere diffuse 1 1 1 1 0 30 0 sphere diffuse 1 1 1 1 -40 0 0");
  EXPECT_GT(p.within({{-3, -3, -3}, {3, 3, 3}}), 10);
  EXPECT_EQ(p.within({{-3, 20, -3}, {3, 40, 3}}), 0);
}

TEST(PredictCost, ShadowRaysGoWhereTheLightIs) {
  const std::string objects =
      "sphere diffuse 1 1 1 2 0 0 0 sphere diffuse 1 1 1 2 0 0 -20 sphere diffuse 1 1 1 2 0 0 20 ";
  const Bounds above{{-3, -3, 4}, {3, 3, 30}}, below{{-3, -3, -30}, {3, 3, -4}};
  const std::string narrow = "screen 32 32 eyep -20 0 0 lookp 0 0 0 up 0 0 1 fov 12 ";
  const Predicted lit = predict(narrow + "light 1 point 0 0 60 " + objects);
  EXPECT_GT(lit.within(above), 10 * lit.within(below));
  const Predicted dark = predict(narrow + "light 1 point 0 0 60 noshadow " + objects);
  EXPECT_LT(dark.within(above), 0.1 * lit.within(above));
  // An area light is asked at every point.
  const Predicted area = predict(narrow + "light 1 area -.5 -.5 60 .5 -.5 60 3 -.5 .5 60 3 " + objects);
  EXPECT_GT(area.within(above), 6 * lit.within(above));
}

TEST(PredictCost, AScaledSceneCostsTheSame) {
  const std::string scene =
      "sphere diffuse 1 1 1 2 0 0 0 box diffuse 1 1 1 -3 -3 -3 3 4 -2 light 1 directional 1 -1 1 ";
  const auto one = predict("screen 32 32 eyep -20 4 4 lookp 0 0 0 up 0 0 1 " + scene).costs;
  const auto other =
      predict(
          "screen 32 32 eyep -40 8 8 lookp 0 0 0 up 0 0 1 "
          "sphere diffuse 1 1 1 4 0 0 0 box diffuse 1 1 1 -6 -6 -6 6 8 -4 light 1 directional 1 -1 1 ")
          .costs;
  ASSERT_EQ(one.size(), other.size());
  ASSERT_GT(one.size(), 100u);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].cost, other[i].cost);
    EXPECT_EQ(one[i].box.low * 2.0, other[i].box.low);
  }
}

TEST(PredictCost, OfAWorldThatIsNoBoxIsNothing) {
  BoundsSample sample;
  sample.add({{0, 0, 0}, {1, 1, 1}});
  SurveySink sink({});
  const SceneHead head = jobOfText("sphere diffuse 1 1 1 1 0 0 0").read(sink);
  const View view = viewOf(head.camera, head.picture).value();
  for (const Bounds& world :
       {Bounds{}, kEverywhere, Bounds{{0, 0, 0}, {0, 0, 0}}, Bounds{{0, 0, 0}, {1e-90, 0, 0}},
        Bounds{{-1e200, 0, 0}, {1e200, 0, 0}}, Bounds{{std::nan(""), 0, 0}, {1, 1, 1}}})
    EXPECT_TRUE(predictCost(world, sample, view, head.picture, head.settings).empty());
  const Bounds flat{{0, -1, -1}, {0, 1, 1}};
  for (const CostBox& c : predictCost(flat, sample, view, head.picture, head.settings)) {
    EXPECT_GT(c.cost, 0);
    EXPECT_FALSE(c.box.empty());
  }
}

}  // namespace
}  // namespace rayshade
