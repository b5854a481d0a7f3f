// Tasks that would have nothing to do are not started, and nobody misses them.
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/schedule/task_counts.h"

#include <gtest/gtest.h>

#include "tests/support/compare_pictures.h"
#include "tests/support/render_text.h"

namespace rayshade {
namespace {

const std::string kPicture = "screen 40 30 sample 1 nojitter eyep 0 -6 2 ";
const std::string kThree =
    "sphere 1 0 0 0 sphere diffuse 1 1 1 0.5 2 0 0 sphere diffuse .2 .9 .2 0.5 -2 0 0 ";

SceneWork needsOfText(const std::string& text) {
  FeatureSink features;
  const SceneHead head = jobOfText(text).read(features);
  return sceneWork(scenePlan(features.features(), head), features.features().shapeCount());
}

HostOptions nearShading(std::uint32_t voxels, std::uint32_t pyramids) {
  HostOptions options;
  options.wishes.voxels = voxels;
  options.wishes.pyramids = pyramids;
  options.policy.shadeLocally = true;
  options.policy.shadows = ShadowPolicy::local;
  return options;
}

// Renders with the tasks that are needed; how many shade tasks there were.
std::size_t rendersTheSame(const std::string& scene, HostOptions options) {
  options.wishes = neededTasks(needsOfText(scene), options, 1).wishes;
  const Job job = jobOfText(scene);
  const RenderedByTasks got = renderByTasks(job, options, {.seed = 5});
  EXPECT_EQ(difference(got.frames, renderSequentially(job).frames), "");
  std::size_t shades = 0;
  for (const TaskSummary& task : got.summary.tasks) {
    shades += task.placement.role == Role::shade;
    EXPECT_EQ(task.report.refused, 0u);
  }
  return shades;
}

TEST(SceneWork, NoMoreVoxelTasksThanObjects) {
  HostOptions options;
  options.wishes.voxels = 8;
  const NeededTasks tasks = neededTasks(needsOfText(kPicture + kThree), options, 1);
  EXPECT_EQ(tasks.wishes.voxels, 3u);
  ASSERT_EQ(tasks.why.size(), 1u);
  EXPECT_EQ(tasks.why[0], "3 instead of 8 voxel-trace tasks: 3 objects");
  options.wishes.voxels = 0;  // by the number of hosts
  EXPECT_EQ(neededTasks(needsOfText(kPicture + kThree), options, 20).wishes.voxels, 3u);
  EXPECT_EQ(neededTasks(needsOfText(kPicture + kThree), options, 1).wishes.voxels, 2u);
}

TEST(SceneWork, NoMorePyramidTasksThanPyramids) {
  HostOptions options;
  options.wishes.pyramids = 9;
  options.tilePixels = 256;  // 1200 rays
  EXPECT_EQ(neededTasks(needsOfText(kPicture + kThree), options, 1).wishes.pyramids, 5u);
  options.wishes.clusters = 7;  // every cluster has somebody to work for
  EXPECT_EQ(neededTasks(needsOfText(kPicture + kThree), options, 1).wishes.pyramids, 7u);
}

TEST(SceneWork, NoShadeTasksWhereNoColourIsWaitedFor) {
  const std::string lit = kPicture + "light 1 point 0 -9 9 ",
                    dark = kPicture + "light 1 point 0 -9 9 noshadow ";
  const std::string mirror = "sphere diffuse 1 1 1 specular 1 1 1 reflect .5 0.5 0 0 2 ";
  EXPECT_EQ(rendersTheSame(dark + kThree, nearShading(2, 1)), 0u);
  EXPECT_EQ(rendersTheSame(dark + kThree, nearShading(3, 0)), 0u);
  EXPECT_EQ(rendersTheSame(lit + kThree, nearShading(1, 0)), 0u);
  EXPECT_EQ(rendersTheSame(lit + kThree, nearShading(2, 0)), 1u);
  EXPECT_EQ(rendersTheSame(lit + kThree, nearShading(1, 1)), 1u);
  EXPECT_EQ(rendersTheSame(dark + kThree + mirror, nearShading(2, 1)), 1u);
  EXPECT_EQ(rendersTheSame(lit + kThree + mirror, nearShading(1, 0)), 0u);
  HostOptions apart = nearShading(2, 1);
  apart.policy.shadeLocally = false;
  EXPECT_EQ(rendersTheSame(dark + kThree, apart), 1u);
}

TEST(SceneWork, AHostThatForgetsTheShadeTasksGetsNoReplyButDoesNoHarm) {
  const std::string scene = kPicture + kThree;
  HostOptions options = nearShading(2, 1);
  options.wishes.shades = 0;
  options.policy.shadeLocally = false;
  options.patienceAtStart = options.killAfter = 1;
  options.mostSuccessions = 1;
  EXPECT_ANY_THROW(renderByTasks(jobOfText(scene), options, {.seed = 1}));
}

}  // namespace
}  // namespace rayshade
