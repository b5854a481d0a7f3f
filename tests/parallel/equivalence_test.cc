// The promise of the whole program: however the work is split and in whatever order messages arrive, the picture has the
// bits of the sequential renderer's.
//
// RAYSHADE_TEST_SEEDS=N tries N random scenes instead of the few of every day.
// guarded: juggles tasks
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "tests/support/compare_pictures.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"
#include "tests/support/render_text.h"
#include "tests/support/seeded_random.h"
#include "tests/support/suite.h"

namespace rayshade {
namespace {

struct Splitting {
  std::uint32_t voxelTasks, voxelsPerTask, shades, window;
  std::uint64_t delivery;
  std::uint32_t pyramids = 0, clusters = 1;
  Split by = Split::equal;
};

std::ostream& operator<<(std::ostream& out, const Splitting& s) {
  return out << "--voxels " << s.voxelTasks << " --voxels-per-task " << s.voxelsPerTask << " --shades "
             << s.shades << " --window " << s.window << " --pyramids " << s.pyramids << " --clusters "
             << s.clusters << " --split " << static_cast<int>(s.by) << ", delivery seed " << s.delivery;
}

Splitting randomSplit(std::uint64_t seed) {
  Random random(seed);
  const auto from = [&](int low, int high) { return static_cast<std::uint32_t>(random.integer(low, high)); };
  return {.voxelTasks = from(1, 8),
          .voxelsPerTask = from(1, 3),
          .shades = from(1, 3),
          .window = random.pick({1u, 7u, 256u, 4096u}),
          .delivery = random.bits(),
          .pyramids = from(0, 2),
          .clusters = from(1, 2),
          .by = random.pick({Split::equal, Split::cost, Split::balanced})};
}

RenderedByTasks renderSplit(const Job& job, const Splitting& split) {
  HostOptions host;
  host.wishes.voxels = split.voxelTasks;
  host.wishes.shades = split.shades;
  host.wishes.pyramids = split.pyramids;
  host.wishes.clusters = split.clusters;
  host.voxelsPerTask = split.voxelsPerTask;
  host.split = split.by;
  host.window = split.window;
  host.policy.shadows = ShadowPolicy{static_cast<std::uint8_t>(split.delivery % 3)};
  SimulatedMachine::Options machine;
  machine.seed = split.delivery;
  return renderByTasks(job, host, machine);
}

// Every ray is followed once, so that the tasks together count what one process counts; the voxels that they visit are
// others, because a task looks at all of its own voxels at once and spares those of others where a ray could meet nothing.
// With adaptive sampling tiles may trace samples that are not needed in the end, whoever traces them.
void expectSameWork(const TraceCounts& sequential, const TraceCounts& tasks) {
  EXPECT_EQ(tasks.hits, sequential.hits);
  EXPECT_EQ(tasks.shadowRays, sequential.shadowRays);
  EXPECT_EQ(tasks.reflectedRays, sequential.reflectedRays);
  EXPECT_EQ(tasks.transmittedRays, sequential.transmittedRays);
}

// A random scene, sampled in one of the ways there are: by nets or strata, by any rule, some of them cut out.
Job randomJob(std::uint64_t seed) {
  Job job = jobOfText(randomScene(seed));
  if (seed % 4 == 1) job.options.sampling = "strata";
  job.options.refinement = seed % 2 == 0 ? "neighbours" : "crosses";
  if (seed % 3 == 0) job.options.crop = {0.2, 0.7, 0.3, 0.9};
  return job;
}

TEST(Equivalence, AnyNumberOfThreadsGivesTheSameBits) {
  const std::uint64_t seeds = seedCount(40);
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("scene seed " + std::to_string(seed));
    const Job job = randomJob(seed);
    const Rendered one = renderSequentially(job);
    for (const unsigned threads : {2u, 3u, 7u}) {
      const Rendered several = renderSequentially(job, 1, threads);
      ASSERT_EQ(difference(several.frames, one.frames), "") << threads << " threads";
      expectSameWork(several.counts, one.counts);
    }
  }
}

// Tasks that hold all of the scene trace tiles with all threads that they have; some of them die.
TEST(Equivalence, ThreadsOfTasksGiveTheSameBitsAfterDeaths) {
  const std::uint64_t seeds = seedCount(40);
  int deaths = 0;
  std::uint64_t tiles = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("scene seed " + std::to_string(seed));
    const Job job = randomJob(seed);
    HostOptions host;
    host.wishes.voxels = 1;
    host.wishes.shades = 0;
    host.wishes.clusters = 1 + static_cast<std::uint32_t>(seed % 3);
    host.policy.shadeLocally = true;
    host.threads = 0;
    host.tilePixels = 64;
    const RenderedByTasks got = renderByTasks(
        job, host,
        {.seed = seed, .cores = 1 + static_cast<unsigned>(seed % 4), .movesPerDeath = 60, .mostDeaths = 3});
    ASSERT_EQ(difference(got.frames, renderSequentially(job).frames), "");
    deaths += got.deaths;
    for (const TaskSummary& task : got.summary.tasks) tiles += task.report.pyramids;
  }
  EXPECT_GT(deaths, 10);
  EXPECT_GT(tiles, 5 * seeds);
}

TEST(Equivalence, RandomScenesHaveTheSameBitsHoweverTheyAreSplit) {
  const std::uint64_t seeds = seedCount(60);
  std::uint64_t colourful = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("scene seed " + std::to_string(seed));
    const Job job = randomJob(seed);
    const Rendered expected = renderSequentially(job);
    for (std::uint64_t trial = 0; trial < 3; ++trial) {
      const Splitting split = randomSplit(3 * seed + trial);
      SCOPED_TRACE(split);
      const RenderedByTasks got = renderSplit(job, split);
      ASSERT_EQ(difference(got.frames, expected.frames), "");
      ASSERT_EQ(got.summary.successions, 0);
      for (const TaskSummary& task : got.summary.tasks) {
        ASSERT_EQ(task.report.refused, 0u);
        ASSERT_EQ(task.report.stale, 0u);
      }
    }
    const std::vector<float>& pixels = expected.frames[0].pixels;
    if (std::any_of(pixels.begin(), pixels.end(), [&](float p) { return p != pixels[0]; })) ++colourful;
  }
  EXPECT_GT(colourful, 9 * seeds / 10) << "the scenes show nothing: the test has lost its teeth";
}

TEST(Equivalence, TheTasksTogetherDoTheWorkOfOneProcessOverTheSameVoxels) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("scene seed " + std::to_string(seed));
    Job job = jobOfText(randomScene(seed));
    job.options.samples = 1;  // none in vain
    Splitting split = randomSplit(1000 + seed);
    split.pyramids = 0;       // they fetch cells instead of sending rays: other visits
    split.by = Split::equal;  // as the sequential renderer cuts
    split.clusters = 1;       // copies: every object is owned more than once
    split.delivery *= 3;      // shadow rays travel, too: ShadowPolicy::forward
    SCOPED_TRACE(split);
    const Rendered expected = renderSequentially(job, split.voxelTasks * split.voxelsPerTask);
    const RenderedByTasks got = renderSplit(job, split);
    ASSERT_EQ(difference(got.frames, expected.frames), "");
    expectSameWork(expected.counts, got.counts);
    EXPECT_EQ(difference(renderSequentially(job).frames, expected.frames), "")
        << "cutting space has changed the picture";
    std::uint64_t owned = 0;
    for (const TaskSummary& task : got.summary.tasks) owned += task.owned;
    EXPECT_EQ(owned, got.summary.objects) << "every object of the world is owned by one task";
  }
}

TEST(Equivalence, EverySplitOfOneSceneHasTheSameBits) {
  const Job job = jobOfText(randomScene(7));
  const Rendered expected = renderSequentially(job);
  std::uint64_t delivery = 0;
  for (std::uint32_t voxels = 1; voxels <= 8; ++voxels)
    for (std::uint32_t perTask = 1; perTask <= 3; ++perTask)
      for (std::uint32_t shades = 1; shades <= 3; ++shades) {
        const Splitting split{voxels, perTask, shades, delivery % 2 == 0 ? 7u : 256u, delivery};
        ++delivery;
        SCOPED_TRACE(split);
        ASSERT_EQ(difference(renderSplit(job, split).frames, expected.frames), "");
      }
}

TEST(Equivalence, TheSamplesOnTheirWayNeverExceedTheWindow) {
  const Job job = jobOfText(randomScene(3));
  for (std::uint32_t window : {1u, 7u, 64u}) {
    const RenderedByTasks got = renderSplit(job, {4, 1, 2, window, window});
    EXPECT_LE(got.summary.peakInFlight, window);
    EXPECT_GT(got.summary.peakInFlight, window / 2);
  }
}

TEST(Equivalence, ScenesOfTheSuiteHaveTheSameBits) {
  std::uint64_t number = 0;
  for (const SuiteScene& scene : suiteScenes()) {
    SCOPED_TRACE(scene.name);
    CurrentDirectory suite(kSuiteDirectory);
    Job job = jobOf(scene.options + " " + scene.name + ".ray");
    job.options.resolution = {40, 30};
    job.options.window = {0, 39, 0, 29};
    const Rendered expected = renderSequentially(job);
    const Splitting split = randomSplit(5000 + number++);
    SCOPED_TRACE(split);
    EXPECT_EQ(difference(renderSplit(job, split).frames, expected.frames), "");
    EXPECT_EQ(expected.frames.size(), static_cast<std::size_t>(scene.frames));
  }
  EXPECT_GE(number, 50u);
}

TEST(Equivalence, AnotherSeedOfTheSamplesIsAnotherPicture) {
  Job job = jobOfText("screen 16 12 eyep 0 -5 0 sample 2 jitter contrast 0 0 0 sphere diffuse 1 1 1 1 0 0 0");
  const Rendered first = renderSequentially(job);
  job.options.seed = 1;
  const Rendered second = renderSequentially(job);
  EXPECT_NE(first.frames, second.frames);
  EXPECT_EQ(difference(renderSplit(job, {3, 1, 1, 64, 0}).frames, second.frames), "");
}

}  // namespace
}  // namespace rayshade
