// What a plan rules out does not happen: plans against what is counted while the same scene is rendered.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/program/scene_plan.h"

#include <gtest/gtest.h>

#include "tests/support/random_scene.h"
#include "tests/support/render_text.h"

namespace rayshade {
namespace {

ScenePlan planOf(const Job& job) {
  FeatureSink sink;
  const SceneHead head = job.read(sink);
  return scenePlan(sink.features(), head);
}
ScenePlan planOfText(const std::string& text) { return planOf(jobOfText(text)); }

// Requires a single frame.
void expectToHold(const ScenePlan& plan, const TraceCounts& counts) {
  EXPECT_GE(counts.primaryRays, plan.eyeRaysAtLeast);
  EXPECT_LE(counts.primaryRays, plan.eyeRaysAtMost);
  EXPECT_LE(counts.shadowRays, counts.hits * plan.shadowRaysPerHit);
  EXPECT_TRUE(plan.shadowRays || counts.shadowRays == 0) << counts.shadowRays;
  EXPECT_TRUE(plan.transmittedRays || counts.transmittedRays == 0) << counts.transmittedRays;
  EXPECT_TRUE(plan.reflectedRays || counts.reflectedRays == 0) << counts.reflectedRays;
}

const std::string kPicture = "screen 16 12 sample 2 nojitter eyep 0 -6 2 ";

TEST(ScenePlan, HoldsForRandomScenes) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const Job job = jobOfText(randomScene(seed) + " screen 12 9 sample 2 maxdepth 3 ");
    expectToHold(planOf(job), renderSequentially(job).counts);
  }
}

struct Feature {
  const char* name;
  std::string without, with;          // scenes
  bool ScenePlan::*planned;           // what the plan says of it
  std::uint64_t TraceCounts::*count;  // rays that exist because of it
};

TEST(ScenePlan, ARayThatTheSceneHasNoUseForIsNeverSentAndOneThatItHasIs) {
  const std::string light = "light 1 point 3 -4 9 ", ball = "sphere s 1 0 0 0 ";
  const Feature features[] = {
      {"shadows", "light 1 point 3 -4 9 noshadow surface s diffuse 1 1 1 " + ball,
       light + "light 1 point 3 -4 9 noshadow surface s diffuse 1 1 1 " + ball, &ScenePlan::shadowRays,
       &TraceCounts::shadowRays},
      {"mirrors", light + "surface s specular 1 1 1 " + ball,
       light + "surface s specular 1 1 1 reflect .5 " + ball, &ScenePlan::reflectedRays,
       &TraceCounts::reflectedRays},
      {"glass", light + "surface s specular 1 1 1 index 1.5 " + ball,
       light + "surface s transp .5 index 1.5 " + ball, &ScenePlan::transmittedRays,
       &TraceCounts::transmittedRays},
      {"glass in a texture",
       light + "surface s diffuse 1 1 1 surface g diffuse 0 0 0 sphere s 1 0 0 0 texture checker s",
       light + "surface s diffuse 1 1 1 surface g transp .5 sphere s 1 0 0 0 texture checker g",
       &ScenePlan::transmittedRays, &TraceCounts::transmittedRays},
      {"depth", light + "maxdepth 0 surface s transp .5 index 1.5 " + ball,
       light + "maxdepth 1 surface s transp .5 index 1.5 " + ball, &ScenePlan::transmittedRays,
       &TraceCounts::transmittedRays},
  };
  for (const Feature& f : features) {
    SCOPED_TRACE(f.name);
    for (const bool used : {false, true}) {
      const Job job = jobOfText(kPicture + (used ? f.with : f.without));
      const ScenePlan plan = planOf(job);
      const TraceCounts counts = renderSequentially(job).counts;
      EXPECT_EQ(plan.*f.planned, used);
      EXPECT_EQ(counts.*f.count > 0, used);
      expectToHold(plan, counts);
    }
  }
}

TEST(ScenePlan, TotalReflectionCountsAsReflection) {
  const Job job =
      jobOfText(kPicture +
                "light 1 point 3 -4 9 surface s transp 1 index 1.5 sphere s 1 0 0 0 box s -1 -1 -2 1 1 -1.2");
  EXPECT_TRUE(planOf(job).reflectedRays);
  EXPECT_GT(renderSequentially(job).counts.reflectedRays, 0u);
}

TEST(ScenePlan, SaysHowManySamplesThereAre) {
  const std::string scene = "light 1 ambient surface black diffuse 0 0 0 surface white ambient 1 1 1 sphere ";
  // One black pixel after the other: only the border gets all samples, and the line below has one in each pixel but two.
  const Job black = jobOfText(kPicture + scene + "black 1 0 0 0");
  EXPECT_EQ(planOf(black).eyeRaysAtLeast, 52u * 4 + 140 + 14);
  EXPECT_EQ(renderSequentially(black).counts.primaryRays, planOf(black).eyeRaysAtLeast);
  // Contrast everywhere.
  const Job all = jobOfText(kPicture + "contrast .01 .01 .01 " + scene +
                            "white 1 0 0 0 texture blotch .5 black scale .01 .01 .01");
  EXPECT_EQ(planOf(all).eyeRaysAtMost, 16u * 12 * 4 + 14);
  EXPECT_LE(renderSequentially(all).counts.primaryRays, planOf(all).eyeRaysAtMost);
  const Job every = jobOfText(kPicture + "contrast 0 0 0 " + scene + "black 1 0 0 0");
  EXPECT_EQ(planOf(every).eyeRaysAtLeast, 16u * 12 * 4);
  EXPECT_EQ(renderSequentially(every).counts.primaryRays, 16u * 12 * 4);
  // One sample in a pixel, or no pixel that is not on the border.
  for (const char* picture : {"screen 16 12 sample 1 ", "screen 2 50 fov 1 sample 3 "}) {
    const Job job = jobOfText(picture + scene + "white 1 0 0 0");
    EXPECT_EQ(planOf(job).eyeRaysAtLeast, planOf(job).eyeRaysAtMost);
    EXPECT_EQ(renderSequentially(job).counts.primaryRays, planOf(job).eyeRaysAtMost);
  }
}

TEST(ScenePlan, CountsWhatTheSceneIsMadeOf) {
  const SceneFeatures f =
      planOfText(
          "light 1 area 0 0 9 1 0 9 2 0 1 9 3 light 1 point 0 0 9 noshadow surface s diffuse 1 1 1 "
          "plane s 0 0 0 0 0 1 texture stripe s 1 .1 "
          "name a list sphere s 1 0 0 0 sphere s 1 2 0 0 end "
          "object a translate 1 0 0 object a rotate 0 0 1 (time) "
          "difference box s 0 0 0 1 1 1 sphere s .5 0 0 0 end texture wood")
          .features;
  EXPECT_EQ(f.shapeCount(), 5u);
  EXPECT_EQ(f.textureCount(), 2u);
  EXPECT_EQ(f.coordinateTextures, 1u);
  EXPECT_EQ(f.instances, 2u);
  EXPECT_EQ(f.csgOperations, 1u);
  EXPECT_EQ(f.unbounded, 1u);
  EXPECT_EQ(f.moving, 1u);
  EXPECT_EQ(f.transforms, 2u);
  EXPECT_EQ(f.transparent + f.reflecting + f.attenuating, 0u);
}

TEST(ScenePlan, AsTextNamesEveryPartOnceUnderWhatItIs) {
  const std::string lines =
      describe(planOfText(kPicture + "light 1 area 0 0 9 1 0 9 2 0 1 9 3 sphere 1 0 0 0"));
  const std::size_t unused = lines.find("\nnot used\n");
  ASSERT_NE(unused, std::string::npos);
  EXPECT_LT(lines.find("  shadow rays       at most 6 for each hit"), unused) << lines;
  for (const char* part :
       {"  textures ", "  CSG ", "  motion ", "  transmitted rays ", "  atmosphere ", "  u and v "}) {
    EXPECT_GT(lines.find(part), unused) << part;
    EXPECT_EQ(lines.find(part), lines.rfind(part)) << part;
  }
}

}  // namespace
}  // namespace rayshade
