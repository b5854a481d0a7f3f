// Renders in virtual time: the picture of the sequential renderer, the same times in every run, and times that make sense.
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/simulation/timed_machine.h"

#include <gtest/gtest.h>

#include "pvm/messages/task_context.h"
#include "tests/support/compare_pictures.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"
#include "tests/support/render_text.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

MachineSpec someMachine(std::uint32_t hosts, std::uint32_t cores = 1) {
  MachineSpec machine;
  machine.hosts = hosts;
  machine.cores = cores;
  machine.network = {NetworkSpec::Kind::networkSwitch, 1, 50e-6, 5e-6, 0, 1e8, 20e-6, 1e9};
  return machine;
}

UnitCosts someCosts() {
  UnitCosts costs;
  costs.nanoseconds = {300, 150, 50, 30, 300, 200, 100, 100, 5000, 0.3, 0.3, 20000, 3};
  return costs;
}

RenderedByTasks renderTimed(const Job& job, const HostOptions& host, const MachineSpec& spec,
                            std::vector<EventLane>* lanes = nullptr) {
  TimedMachine machine(spec, someCosts(), spec.hosts * spec.cores);
  return renderOn(machine, job, host, lanes, [&](const HostTask& task) {
    machine.countHost([&task] {
      Report report;
      addTo(report, task.traffic());
      return report;
    });
  });
}

HostOptions someTasks(std::uint64_t seed) {
  Random random(seed);
  HostOptions host;
  host.wishes.voxels = static_cast<std::uint32_t>(random.integer(1, 5));
  host.wishes.pyramids = static_cast<std::uint32_t>(random.integer(0, 3));
  host.wishes.shades = static_cast<std::uint32_t>(random.integer(1, 2));
  host.policy.shadows = ShadowPolicy{static_cast<std::uint8_t>(seed % 3)};
  host.policy.shadeLocally = seed % 2 == 0;
  host.tilePixels = 64;
  return host;
}

TEST(TimedMachine, HasTheBitsOfTheSequentialRenderer) {
  const std::uint64_t seeds = seedCount(30);
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("scene seed " + std::to_string(seed));
    const Job job = jobOfText(randomScene(seed));
    MachineSpec machine = someMachine(1 + static_cast<std::uint32_t>(seed % 6), 1 + seed % 2);
    machine.network.kind = NetworkSpec::Kind{static_cast<std::uint8_t>(seed % 3)};
    machine.network.columns = 1 + static_cast<std::uint32_t>(seed % 2);
    const RenderedByTasks got = renderTimed(job, someTasks(seed), machine);
    ASSERT_EQ(difference(got.frames, renderSequentially(job).frames), "");
    EXPECT_EQ(got.summary.successions, 0);
    for (const TaskSummary& task : got.summary.tasks) EXPECT_EQ(task.report.refused + task.report.stale, 0u);
  }
}

// Threads of tasks are jobs on processors.
TEST(TimedMachine, ThreadsOfATaskUseTheProcessorsOfTheirHost) {
  const Job job = jobOfText("screen 512 512 eyep 0 -5 0 sample 1 sphere diffuse 1 1 1 1 0 0 0");
  HostOptions host;
  host.wishes.voxels = 1;
  host.wishes.shades = 0;
  host.policy.shadeLocally = true;
  host.threads = 0;
  host.tilePixels = 1024;
  const RenderedByTasks one = renderTimed(job, host, someMachine(1, 1)),
                        four = renderTimed(job, host, someMachine(1, 4));
  EXPECT_EQ(difference(one.frames, four.frames), "");
  EXPECT_LT(four.summary.traceSeconds, 0.5 * one.summary.traceSeconds);
  EXPECT_GT(four.summary.traceSeconds, 0.2 * one.summary.traceSeconds);
}

TEST(TimedMachine, TheSameRunHasTheSameTimesToTheNanosecond) {
  const Job job = jobOfText(randomScene(11));
  std::vector<EventLane> first, second;
  const RenderedByTasks a = renderTimed(job, someTasks(4), someMachine(4), &first);
  const RenderedByTasks b = renderTimed(job, someTasks(4), someMachine(4), &second);
  EXPECT_EQ(a.summary.startSeconds, b.summary.startSeconds);
  EXPECT_EQ(a.summary.traceSeconds, b.summary.traceSeconds);
  ASSERT_EQ(first.size(), second.size());
  std::size_t events = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].log.events, second[i].log.events) << first[i].name();
    events += first[i].log.events.size();
  }
  EXPECT_GT(events, 100u);
}

TEST(TimedMachine, BusyAndIdleAreAllOfTheTime) {
  const Job job = jobOfText(randomScene(11));
  std::vector<EventLane> lanes;
  const RenderedByTasks got = renderTimed(job, someTasks(4), someMachine(4), &lanes);
  for (const TaskSummary& task : got.summary.tasks) {
    const Report& r = task.report;
    EXPECT_GT(r.cpuSeconds, 0) << programName(task.placement.role);
    EXPECT_LE(r.cpuSeconds, r.busySeconds + 1e-6);
    EXPECT_LE(r.waitSeconds, r.idleSeconds);
    UnitCosts costs = someCosts();
    // What it costs is what it has counted, but for looks at an empty link; overheads come to it.
    EXPECT_GE(r.cpuSeconds, 0.99e-9 * costs.of(r));
  }
}

TEST(TimedMachine, LatencyAndFewerProcessorsTakeLonger) {
  const Job job = jobOfText(
      "screen 100 100 eyep 0 -5 0 sample 1 light 1 point 3 -3 3 sphere diffuse 1 1 1 specular 1 1 1 reflect "
      "0.5 1 0 0 0\n"
      "sphere 0.7 1.2 0 0.3 plane 0 0 -1 0 0 1");
  HostOptions host;
  host.wishes.voxels = 4;
  host.wishes.shades = 1;
  const auto traceSeconds = [&](std::uint32_t hosts, double latency, double speed) {
    MachineSpec machine = someMachine(hosts);
    machine.network.latency = latency;
    machine.speed = speed;
    return renderTimed(job, host, machine).summary.traceSeconds;
  };
  const double usual = traceSeconds(5, 50e-6, 1);
  EXPECT_GT(traceSeconds(5, 20e-3, 1), usual + 0.03);
  // Small work is done sooner on one host, which has no network.
  EXPECT_GT(traceSeconds(1, 50e-6, 0.01), 1.2 * traceSeconds(5, 50e-6, 0.01));
  EXPECT_GT(traceSeconds(5, 50e-6, 0.1), 2 * usual);
}

TEST(TimedMachine, HasNoMoreProcessorsThanItHas) {
  EXPECT_THROW(TimedMachine(someMachine(2), someCosts(), 3), std::runtime_error);
  EXPECT_EQ(TimedMachine(someMachine(4, 4), someCosts(), 6).hosts().size(), 2u);
}

}  // namespace
}  // namespace rayshade
