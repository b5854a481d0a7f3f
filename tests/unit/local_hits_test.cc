// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/local_hits.h"

#include <gtest/gtest.h>

#include "tests/support/compare_pictures.h"
#include "tests/support/render_text.h"

namespace rayshade {
namespace {

ReturnPath mirror() {
  ReturnPath back;
  back.reflected = true;
  return back;
}

TEST(LocalHits, APlaceIsUsedAgainWhenTheHitIsComplete) {
  LocalHits hits;
  ReturnPath glass = mirror();
  glass.transmitted = true;
  const std::uint64_t first = hits.add(kWhite, glass, {TaskId{1}, 2, 3});
  const std::uint64_t second = hits.add(kWhite, mirror(), {TaskId{1}, first, kReflectedSlot});
  EXPECT_NE(first, second);
  ASSERT_NE(hits.arrive(first, kReflectedSlot, kBlack), nullptr);
  EXPECT_EQ(hits.arrive(first, kTransmittedSlot, kWhite)->missing, 0);
  EXPECT_EQ(hits.size(), 2u);
  hits.release(first);
  EXPECT_EQ(hits.size(), 1u);
  EXPECT_EQ(hits.add(kBlack, mirror(), {}), first);
  const LocalHit* const again = hits.arrive(first, kReflectedSlot, kWhite);
  ASSERT_NE(again, nullptr);
  EXPECT_EQ(again->sum, kBlack);
  EXPECT_FALSE(again->transmitted);
  hits.clear();
  EXPECT_EQ(hits.size(), 0u);
}

TEST(LocalHits, ColoursThatNobodyWaitsForAreRefused) {
  LocalHits hits;
  const std::uint64_t hit = hits.add(kWhite, mirror(), {TaskId{1}, 2, 3});
  EXPECT_EQ(hits.arrive(hit + 1, kReflectedSlot, kWhite), nullptr);
  EXPECT_EQ(hits.arrive(~std::uint64_t{0}, kReflectedSlot, kWhite), nullptr);
  EXPECT_EQ(hits.arrive(hit, kTransmittedSlot, kWhite), nullptr);
  EXPECT_EQ(hits.arrive(hit, 5, kWhite), nullptr);
  EXPECT_NE(hits.arrive(hit, kReflectedSlot, kWhite), nullptr);
  EXPECT_EQ(hits.arrive(hit, kReflectedSlot, kWhite), nullptr);
  hits.release(hit);
  EXPECT_EQ(hits.arrive(hit, kReflectedSlot, kWhite), nullptr);
}

// Mirrors between mirrors, and glass, cut in two: hits wait for rays of their own task and of others; those whose light comes from
// elsewhere go over to the shade task.
const std::string kHall =
    "screen 48 36 sample 1 nojitter eyep 0 -9 1 maxdepth 7 light 1 point 3 -9 9 light .4 directional -1 -1 1 "
    "surface mirror diffuse .2 .2 .2 specular 1 1 1 reflect .7 "
    "surface glass diffuse 0 0 0 specular 1 1 1 reflect .3 transp .8 body 1 1 1 index 1.3 "
    "plane mirror 0 0 -1  0 0 1 sphere mirror 1 -2 0 0 sphere glass 1 0 -1 0 sphere mirror 1 2 0 0 "
    "sphere glass .6 1 -2 .5 sphere mirror .5 -1 -2 0 box mirror -1 2 -1  1 3 2 ";

TEST(LocalHits, AHitIsShadedOnceByWhoeverHasItsLastColour) {
  const Job job = jobOfText(kHall);
  const auto alone = renderSequentially(job);
  for (const std::uint32_t voxels : {1u, 2u, 3u, 6u}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      HostOptions options;
      options.wishes.voxels = voxels;
      options.wishes.shades = 2;
      options.policy.shadeLocally = true;
      const RenderedByTasks got = renderByTasks(job, options, {.seed = seed});
      EXPECT_EQ(difference(got.frames, alone.frames), "");
      std::uint64_t near = 0, far = 0, hits = 0;
      for (const TaskSummary& task : got.summary.tasks) {
        const Report& report = task.report;
        (task.placement.role == Role::shade ? far : near) += report.combined;
        hits += report.counts.hits;
        EXPECT_EQ(report.refused, 0u);
      }
      EXPECT_GT(near, 0u);
      EXPECT_EQ(far > 0, voxels > 1);
      EXPECT_EQ(near + far, hits);
    }
  }
}

}  // namespace
}  // namespace rayshade
