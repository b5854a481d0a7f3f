// What travels, rays or objects, and how far pyramids go, is a question of time: the picture has the same bits.
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

HostOptions randomSchedule(std::uint64_t seed) {
  Random random(seed);
  const auto from = [&](int low, int high) { return static_cast<std::uint32_t>(random.integer(low, high)); };
  HostOptions host;
  host.wishes.voxels = from(1, 4);
  host.wishes.pyramids = from(0, 3);
  host.wishes.shades = from(1, 2);
  host.wishes.clusters = from(1, 3);
  host.voxelsPerTask = from(1, 2);
  host.window = random.pick({5u, 300u, 4096u});
  host.cells = random.pick({1u, 8u, 60u, 400u});
  host.tilePixels = random.pick({1u, 16u, 256u});
  host.dynamicShading = random.oneIn(4);
  host.threads = random.pick({0u, 1u, 3u});
  host.split = random.pick({Split::equal, Split::cost, Split::balanced});
  DemandPolicy& policy = host.policy;
  policy.shadows = random.pick({ShadowPolicy::forward, ShadowPolicy::local, ShadowPolicy::automatic});
  policy.secondariesTravel = !random.oneIn(3);
  policy.shadeLocally = random.oneIn(2);
  policy.cacheBytes =
      random.pick<std::uint64_t>({0, 1, 20'000, 1 << 26});  // none, no room for any cell, a few, all
  policy.outstanding = random.pick({1u, 64u});
  policy.horizon = random.pick<Horizon>({{Horizon::Kind::automatic, 0},
                                         {Horizon::Kind::cells, 0},
                                         {Horizon::Kind::cells, 3},
                                         {Horizon::Kind::cells, 1e9},
                                         {Horizon::Kind::distance, 0},
                                         {Horizon::Kind::distance, 8}});
  return host;
}

TEST(Schedules, AnyPolicyAnyHorizonAnyCacheGivesTheSameBits) {
  const std::uint64_t seeds = seedCount(60);
  std::uint64_t pyramidRays = 0, forwarded = 0, evicted = 0, shadowCells = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("scene seed " + std::to_string(seed));
    const Job job = jobOfText(randomScene(seed));
    const Rendered expected = renderSequentially(job);
    for (std::uint64_t trial = 0; trial < 3; ++trial) {
      SCOPED_TRACE("trial " + std::to_string(trial));
      const RenderedByTasks got =
          renderByTasks(job, randomSchedule(7 * seed + trial), {.seed = seed + 1000 * trial, .cores = 2});
      ASSERT_EQ(difference(got.frames, expected.frames), "");
      ASSERT_EQ(got.summary.successions, 0);
      for (const TaskSummary& task : got.summary.tasks) {
        ASSERT_EQ(task.report.refused, 0u);
        ASSERT_EQ(task.report.stale, 0u);
        pyramidRays += task.report.pyramidRays;
        forwarded += task.report.forwardedRays;
        evicted += task.report.cache.evicted;
        shadowCells += task.report.shadowCache.hits;
      }
    }
  }
  EXPECT_GT(pyramidRays, forwarded);
  EXPECT_GT(forwarded, 0u) << "no ray went beyond a horizon";
  EXPECT_GT(evicted, 0u) << "no cache was ever full";
  EXPECT_GT(shadowCells, 0u) << "no shadow ray used a fetched cell";
}

TEST(Schedules, DeathsOfAnyKindOfTaskLeaveThePictureAsItIs) {
  const std::uint64_t seeds = seedCount(60);
  std::uint64_t deaths = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Job job = jobOfText(randomScene(seed % 8));
    HostOptions host = randomSchedule(90'000 + seed);
    host.wishes.pyramids = std::max(1u, host.wishes.pyramids);
    SimulatedMachine::Options machine{.seed = seed};
    machine.movesPerDeath = 300;
    machine.mostDeaths = 3;
    const RenderedByTasks got = renderByTasks(job, host, machine);
    ASSERT_EQ(difference(got.frames, renderSequentially(job).frames), "");
    deaths += static_cast<std::uint64_t>(got.deaths);
  }
  EXPECT_GT(deaths, seeds);
}

TEST(Schedules, ScenesOfTheSuiteHaveTheSameBits) {
  std::uint64_t number = 0;
  for (const SuiteScene& scene : suiteScenes()) {
    SCOPED_TRACE(scene.name);
    CurrentDirectory suite(kSuiteDirectory);
    Job job = jobOf(scene.options + " " + scene.name + ".ray");
    job.options.resolution = {40, 30};
    job.options.window = {0, 39, 0, 29};
    HostOptions host = randomSchedule(70'000 + number);
    host.wishes.pyramids = 1 + static_cast<std::uint32_t>(number % 2);
    EXPECT_EQ(difference(renderByTasks(job, host, {.seed = number}).frames, renderSequentially(job).frames),
              "");
    ++number;
  }
}

TEST(Schedules, RaysTravelWhereACacheHasNoRoom) {
  Job job = jobOfText(randomScene(5));
  HostOptions host;
  host.wishes = {.voxels = 2, .pyramids = 2, .shades = 1};
  host.cells = 200;
  host.policy.cacheBytes = 0;
  host.policy.shadows = ShadowPolicy::local;
  host.policy.secondariesTravel = false;
  host.policy.horizon = {Horizon::Kind::cells, 1e9};
  const RenderedByTasks got = renderByTasks(job, host, {.seed = 3});
  EXPECT_EQ(difference(got.frames, renderSequentially(job).frames), "");
  for (const TaskSummary& task : got.summary.tasks) EXPECT_EQ(task.report.cache.fetched, 0u);
}

// A heap of many small objects: every cell is small beside the cache.
TEST(Schedules, NoTaskHoldsMoreThanItsCache) {
  std::uint64_t givenOn = 0;  // by tasks that had fetched it themselves
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::string text = "eyep 0 -12 0\nscreen 32 32\nlight 1 point 9 -9 20\n";
    for (int i = 0; i < 3000; ++i) {
      const auto at = [&] { return std::to_string(random.real(-3, 3)) + " "; };
      text += "sphere 0.05 " + at() + at() + at() + "\n";
    }
    const Job job = jobOfText(text);
    HostOptions host;
    host.wishes = {.voxels = 2, .pyramids = 2, .shades = 1};
    host.policy.cacheBytes = random.pick<std::uint64_t>({40'000, 100'000, 300'000});
    host.policy.shadeLocally = true;
    host.policy.shadows = random.pick({ShadowPolicy::local, ShadowPolicy::automatic});
    host.policy.secondariesTravel = random.oneIn(2);
    if (random.oneIn(2)) host.policy.horizon = {Horizon::Kind::cells, 1e9};
    host.tilePixels = 64;
    const RenderedByTasks got = renderByTasks(job, host, {.seed = seed});
    EXPECT_EQ(difference(got.frames, renderSequentially(job).frames), "");
    std::uint64_t fetched = 0;
    for (const TaskSummary& task : got.summary.tasks) {
      EXPECT_LE(task.report.cache.peakBytes, host.policy.cacheBytes);
      fetched += task.report.cache.fetched;
      if (task.placement.role == Role::pyramidTrace) givenOn += task.report.cellsServed;
    }
    EXPECT_GT(fetched, 0u);
  }
  EXPECT_GT(givenOn, 0u);
}

}  // namespace
}  // namespace rayshade
