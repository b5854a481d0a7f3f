// Tasks die, hang and lose their last words, at any moment: the picture keeps its bits, or the render ends with one
// message.
//
// RAYSHADE_TEST_SEEDS=N makes N renders of each kind instead of the few hundred of every day.  A failure prints the
// seed that repeats it.
// guarded: juggles tasks
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "tests/support/compare_pictures.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"
#include "tests/support/render_text.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

// Small, and with everything on its way: shadows, glass, mirrors, several lights.
constexpr const char* kGlassAndMirrors = R"(
screen 12 9  sample 2 jitter  contrast .1 .1 .1  maxdepth 4  background .2 .3 .5
eyep 0 -8 2  lookp 0 0 0  fov 40
light .6 point -3 -6 6
light .5 directional 1 -1 2
surface glass  ambient 0 0 0 diffuse .1 .1 .1 specular .4 .4 .4 specpow 40 reflect .3 transp .6 body .8 1 .8 index 1.5
surface mirror ambient .1 .1 .1 diffuse .3 .2 .1 specular .9 .9 .9 specpow 20 reflect .7
surface matt   ambient .1 .1 .1 diffuse .7 .6 .5
plane mirror 0 0 -1.2  0 0 1 texture checker matt
sphere glass 1 -1 0 0
sphere mirror .8 1.2 .5 0
list
  box matt .5 -2 -1  1 -1.5 -.2
  difference  sphere matt 1 0 2 .5  sphere glass .7 0 1.3 1 end
end translate .2 0 0
)";

struct KnownJob {
  Job job;
  Rendered expected;
};

const KnownJob& glassAndMirrors() {
  static const KnownJob ready = [] {
    KnownJob made{jobOfText(kGlassAndMirrors), {}};
    made.expected = renderSequentially(made.job);
    return made;
  }();
  return ready;
}

// As patient as virtual time allows.
HostOptions host(std::uint32_t voxels, std::uint32_t shades, std::uint32_t window) {
  HostOptions options;
  options.mostEarlyDeaths = options.mostSuccessions;  // these tests kill at any time
  options.wishes.voxels = voxels;
  options.wishes.shades = shades;
  options.policy.shadows = ShadowPolicy::forward;
  options.window = window;
  options.pingAfter = 0.05;
  options.killAfter = 0.2;
  options.patienceAtStart = 0.5;
  return options;
}

HostOptions randomHost(std::uint64_t seed) {
  Random random(seed);
  const auto from = [&](int low, int high) { return static_cast<std::uint32_t>(random.integer(low, high)); };
  const std::uint32_t voxels = from(1, 4), shades = from(1, 2);
  HostOptions options = host(voxels, shades, random.pick({4u, 16u, 64u, 4096u}));
  options.voxelsPerTask = from(1, 2);
  options.wishes.pyramids = from(0, 2);
  options.policy.shadows = ShadowPolicy{static_cast<std::uint8_t>(from(0, 2))};
  options.wishes.clusters = from(1, 2);
  return options;
}

TEST(Fault, DeathsAtAnyMoveWithLossOfLastWordsLeaveThePictureAsItIs) {
  const auto& [job, expected] = glassAndMirrors();
  const std::uint64_t seeds = seedCount(400);
  std::uint64_t deaths = 0, successions = 0, reissued = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SimulatedMachine::Options machine;
    machine.seed = seed;
    machine.movesPerDeath = 20 << (seed % 5);
    machine.mostDeaths = 1 + static_cast<int>(seed % 7);
    const RenderedByTasks got = renderByTasks(job, randomHost(seed), machine);
    ASSERT_EQ(difference(got.frames, expected.frames), "") << "seed " << seed;
    deaths += static_cast<std::uint64_t>(got.deaths);
    successions += static_cast<std::uint64_t>(got.summary.successions);
    reissued += got.summary.reissued;
  }
  EXPECT_GT(deaths, seeds) << "the machine was too kind";
  EXPECT_GT(successions, seeds / 2);
  EXPECT_GT(reissued, seeds) << "nothing was ever on its way when a task died";
}

TEST(Fault, HangsAreNoticedAndReplaced) {
  const auto& [job, expected] = glassAndMirrors();
  const std::uint64_t seeds = seedCount(60);
  int hangs = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SimulatedMachine::Options machine;
    machine.seed = seed;
    machine.movesPerHang = 50 << (seed % 4);
    machine.movesPerDeath = seed % 3 == 0 ? 200 : 0;
    machine.mostDeaths = 1 + static_cast<int>(seed % 3);
    const RenderedByTasks got = renderByTasks(job, randomHost(seed), machine);
    ASSERT_EQ(difference(got.frames, expected.frames), "") << "seed " << seed;
    hangs += got.deaths;
  }
  EXPECT_GT(hangs, 0);
}

TEST(Fault, RandomScenesSurviveRandomDeaths) {
  const std::uint64_t seeds = seedCount(40);
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Job job = jobOfText(randomScene(10000 + seed));
    SimulatedMachine::Options machine;
    machine.seed = seed;
    machine.movesPerDeath = 100;
    machine.mostDeaths = 5;
    const RenderedByTasks got = renderByTasks(job, randomHost(seed), machine);
    ASSERT_EQ(difference(got.frames, renderSequentially(job).frames), "") << "seed " << seed;
  }
}

// ---- aimed

// Is there an M in the packet?
template <class M>
bool holds(std::span<const std::byte> packet) {
  Reader reader(packet);
  std::uint8_t version = 0;
  Epoch epoch{};
  reader(version, epoch);
  while (reader.ok() && reader.left() > 0) {
    std::uint8_t tag = 0, position = 0;
    reader(tag);
    if (tag == PositionIn<M, AllMessages>::value) return true;
    AllMessages::forEach([&]<class Other>() {
      if (position++ != tag) return;
      Other skipped{};
      reader(skipped);
    });
  }
  return false;
}

enum class Victim { sender, receiver };

// Kills once for every number in `when`: at the delivery of that many packets with an M in it.
template <class M>
RenderedByTasks renderAiming(const Job& job, const HostOptions& options, std::uint64_t seed, Victim victim,
                             const std::vector<int>& when) {
  SimulatedMachine::Options machineOptions;
  machineOptions.seed = seed;
  int seen = 0;
  return renderByTasks(job, options, machineOptions, [&](SimulatedMachine& machine) {
    machine.beforeDelivery = [&](TaskId from, TaskId to, std::span<const std::byte> packet) {
      if (!holds<M>(packet)) return;
      const bool strike = std::find(when.begin(), when.end(), seen++) != when.end();
      const TaskId target = victim == Victim::sender ? from : to;
      if (!strike || target == machine.self()) return;
      machine.kill(target);
    };
  });
}

template <class M>
void expectSurvival(Victim victim, std::uint64_t base) {
  const auto& [job, expected] = glassAndMirrors();
  int struck = 0;
  for (std::uint64_t seed = base; seed < base + 6; ++seed)
    for (const std::vector<int>& when :
         std::vector<std::vector<int>>{{0}, {1}, {2}, {3}, {0, 1, 2}, {0, 3, 4, 5, 6}, {10, 11, 25}}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", from the packet " + std::to_string(when.front()));
      const RenderedByTasks got = renderAiming<M>(job, host(3, 2, 32), seed, victim, when);
      ASSERT_EQ(difference(got.frames, expected.frames), "");
      struck += got.summary.successions;
    }
  EXPECT_GT(struck, 20) << "hardly anybody died of message " << PositionIn<M, AllMessages>::value;
}

TEST(Fault, DeathOfTheOneWhoIsTold) {
  expectSurvival<Configure>(Victim::receiver, 0);
  expectSurvival<Forget>(Victim::receiver, 100);
  expectSurvival<Items>(Victim::receiver, 200);
  expectSurvival<RayTask>(Victim::receiver, 300);
  expectSurvival<ShadowTask>(Victim::receiver, 400);
  expectSurvival<Expect>(Victim::receiver, 500);
  expectSurvival<Answer>(Victim::receiver, 600);
}

TEST(Fault, DeathOfTheOneWhoSpeaks) {
  expectSurvival<ItemsTaken>(Victim::sender, 0);
  expectSurvival<Ready>(Victim::sender, 100);
  expectSurvival<RayTask>(Victim::sender, 200);
  expectSurvival<Expect>(Victim::sender, 300);
  expectSurvival<Answer>(Victim::sender, 400);
}

TEST(Fault, DeathWhileReportsAreAwaitedEndsTheRenderAllTheSame) {
  const auto& [job, expected] = glassAndMirrors();
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const RenderedByTasks got = renderAiming<Report>(job, host(3, 2, 32), seed, Victim::sender, {0, 2});
    EXPECT_EQ(difference(got.frames, expected.frames), "");
    EXPECT_EQ(got.summary.tasks.size(), 5u);
  }
}

// A shipping of many batches, so that tasks die in the middle of it.
TEST(Fault, DeathInTheMiddleOfALongShipping) {
  std::string text = "screen 8 6 sample 1 nojitter eyep 0 -30 0 ";
  Random random(1);
  const auto coordinate = [&] { return " " + std::to_string(random.integer(-10, 9)); };
  for (int i = 0; i < 6000; ++i) text += "sphere .4" + coordinate() + coordinate() + coordinate() + "\n";
  const Job job = jobOfText(text);
  const Rendered expected = renderSequentially(job);
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    const RenderedByTasks got =
        renderAiming<Items>(job, host(2, 1, 64), seed, Victim::receiver, {static_cast<int>(seed) % 3, 5});
    EXPECT_EQ(difference(got.frames, expected.frames), "");
    EXPECT_GE(got.summary.successions, 1);
  }
}

// ---- the end of patience

std::string messageOf(const std::function<void()>& what) {
  try {
    what();
  } catch (const HostError& error) {
    return error.what();
  }
  return "";
}

TEST(Fault, TasksThatAlwaysDieEndTheRenderWithAMessage) {
  const auto& [job, expected] = glassAndMirrors();
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    SimulatedMachine::Options machine;
    machine.seed = seed;
    HostOptions options = host(3, 1, 64);
    options.mostSuccessions = 10;
    if (seed % 2 == 0) options.mostEarlyDeaths = 3;
    EXPECT_NE(messageOf([&, &job = job] {
                renderByTasks(job, options, machine, [](SimulatedMachine& m) {
                  m.beforeDelivery = [&m](TaskId, TaskId to, std::span<const std::byte> packet) {
                    if (holds<Configure>(packet) || holds<Forget>(packet)) m.kill(to);
                  };
                });
              })
                  .find(seed % 2 == 0 ? "given up after 3 deaths before it was ready"
                                      : "given up after 10 successors"),
              std::string::npos);
  }
}

TEST(Fault, TasksThatAlwaysHangEndTheRenderWithAMessage) {
  const auto& [job, expected] = glassAndMirrors();
  SimulatedMachine::Options machine;
  machine.movesPerHang = 1;
  machine.mostDeaths = 1 << 30;
  HostOptions options = host(2, 1, 64);
  options.mostSuccessions = 5;
  EXPECT_NE(messageOf([&, &job = job] { renderByTasks(job, options, machine); }), "");
}

// ---- memory

TEST(Fault, WhatWaitsIsBoundedByTheWindowAndNotByThePicture) {
  std::size_t small = 0, large = 0;
  for (const char* size : {"screen 24 18", "screen 96 72"}) {
    Job job = jobOfText(std::string(kGlassAndMirrors) + size);
    SimulatedMachine::Options machine;
    machine.seed = 3;
    const RenderedByTasks got = renderByTasks(job, host(3, 2, 32), machine);
    std::uint64_t waiting = 0;
    for (const TaskSummary& task : got.summary.tasks) waiting += task.report.peakQueue;
    // A sample has at most a ray, a record and the shadow rays of its intersection per level of its tree in work.
    EXPECT_LT(waiting, 32u * 5 * 4 * 2) << size;
    (small == 0 ? small : large) = got.peakQueue;
  }
  EXPECT_LT(large, 3 * small + 16) << "sixteen times the pixels must not mean more packets on their way";
}

TEST(Fault, WhatWaitsStaysBoundedWhenTasksDie) {
  const auto& [job, expected] = glassAndMirrors();
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SimulatedMachine::Options machine;
    machine.seed = seed;
    machine.movesPerDeath = 50;
    machine.mostDeaths = 20;
    machine.largestQueue = 400;  // throws
    const RenderedByTasks got = renderByTasks(job, host(3, 2, 16), machine);
    ASSERT_EQ(difference(got.frames, expected.frames), "") << "seed " << seed;
    EXPECT_LE(got.summary.peakInFlight, 16u);
  }
}

TEST(Fault, OfTheDeadNothingIsBelieved) {
  // Without deaths nothing is stale; with deaths in the middle of the work old messages are refused by their epoch.
  const auto& [job, expected] = glassAndMirrors();
  std::uint64_t stale = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const RenderedByTasks got = renderAiming<Answer>(job, host(4, 2, 64), seed, Victim::sender, {20, 40});
    EXPECT_EQ(difference(got.frames, expected.frames), "");
    for (const TaskSummary& task : got.summary.tasks) {
      stale += task.report.stale;
      EXPECT_EQ(task.report.refused, 0u) << "seed " << seed;
    }
  }
  EXPECT_GT(stale, 0u);
}

}  // namespace
}  // namespace rayshade
