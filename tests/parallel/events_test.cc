// What is noted during a render by tasks adds up to what they report.
// guarded: juggles tasks
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "tests/support/compare_pictures.h"
#include "tests/support/random_scene.h"
#include "tests/support/render_text.h"

namespace rayshade {
namespace {

const EventTotal& totalOf(const EventLane& lane, EventKind kind) {
  return lane.log.totals[static_cast<std::size_t>(kind)];
}

HostOptions someTasks(std::uint64_t seed) {
  HostOptions host;
  host.wishes.voxels = 2;
  host.wishes.shades = 1;
  host.wishes.pyramids = static_cast<std::uint32_t>(seed % 3);
  host.policy.shadows = ShadowPolicy::automatic;
  host.policy.shadeLocally = seed % 2 == 0;
  host.policy.cacheBytes = 20'000;  // cells must go again
  host.tilePixels = 64;
  return host;
}

TEST(NotedEvents, AddUpToWhatTasksReport) {
  std::uint64_t cells = 0, thrown = 0, tiles = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE("scene seed " + std::to_string(seed));
    const Job job = jobOfText(randomScene(seed));
    std::vector<EventLane> lanes;
    const RenderedByTasks got = renderByTasks(job, someTasks(seed), {.seed = seed}, {}, &lanes);
    EXPECT_EQ(difference(got.frames, renderSequentially(job).frames), "");
    ASSERT_EQ(lanes.size(), got.summary.tasks.size() + 1);
    EXPECT_EQ(lanes.back().role, "host");
    std::uint64_t pyramids = 0;
    for (const EventLane& lane : lanes) {
      if (lane.role == "host") continue;
      SCOPED_TRACE(lane.name());
      const auto task =
          std::find_if(got.summary.tasks.begin(), got.summary.tasks.end(),
                       [&](const TaskSummary& t) { return static_cast<std::int32_t>(t.task) == lane.task; });
      ASSERT_NE(task, got.summary.tasks.end());
      const Report& report = task->report;
      const EventTotal &out = totalOf(lane, EventKind::encode), &in = totalOf(lane, EventKind::decode);
      EXPECT_EQ(out.events, report.packetsOut);
      EXPECT_EQ(out.count, report.messagesOut);
      EXPECT_EQ(out.amount, report.bytesOut);
      EXPECT_EQ(totalOf(lane, EventKind::content).count, report.messagesOut);
      EXPECT_EQ(in.events, report.packetsIn);
      EXPECT_EQ(in.count, report.messagesIn);
      EXPECT_EQ(in.amount, report.bytesIn);
      EXPECT_EQ(totalOf(lane, EventKind::cell).events, report.cache.fetched);
      EXPECT_EQ(totalOf(lane, EventKind::thrown).count, report.cache.evicted);
      EXPECT_EQ(totalOf(lane, EventKind::epoch).events, got.summary.epochs);
      EXPECT_EQ(lane.log.dropped, 0u);
      cells += report.cache.fetched;
      thrown += report.cache.evicted;
      pyramids += report.pyramids;
    }
    EXPECT_EQ(totalOf(lanes.back(), EventKind::given).events, pyramids);
    EXPECT_EQ(totalOf(lanes.back(), EventKind::taken).events, pyramids);
    tiles += pyramids;
  }
  EXPECT_GT(cells, 0u);
  EXPECT_GT(thrown, 0u);
  EXPECT_GT(tiles, 0u);
}

// What was sent before the end is what was received, packet by packet.
TEST(NotedEvents, PacketsHaveTwoEnds) {
  const Job job = jobOfText(randomScene(4));
  std::vector<EventLane> lanes;
  renderByTasks(job, someTasks(1), {.seed = 4}, {}, &lanes);
  using Key = std::tuple<std::int32_t, std::int32_t, std::uint32_t>;
  std::map<Key, std::uint64_t> sent, received;
  for (const EventLane& lane : lanes)
    for (const Event& event : lane.log.events) {
      if (event.kind == EventKind::encode) sent[{lane.task, event.peer, event.number}] = event.amount;
      if (event.kind == EventKind::decode) received[{event.peer, lane.task, event.number}] = event.amount;
    }
  std::size_t both = 0;
  for (const auto& [packet, bytes] : received) {
    const auto end = sent.find(packet);
    if (end == sent.end()) continue;  // the last words of a task, which its record does not hold
    ++both;
    EXPECT_EQ(end->second, bytes);
  }
  // A task that has ended receives nothing more.
  EXPECT_GE(both, sent.size() * 9 / 10);
  EXPECT_LE(received.size() - both, lanes.size() - 1);
}

TEST(NotedEvents, TellOfDeathsAndEpochs) {
  const Job job = jobOfText(randomScene(5));
  int deaths = 0;
  std::uint64_t noted = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    std::vector<EventLane> lanes;
    const RenderedByTasks got = renderByTasks(
        job, someTasks(seed), {.seed = seed, .movesPerDeath = 100, .mostDeaths = 2}, {}, &lanes);
    deaths += got.summary.successions;
    noted += totalOf(lanes.back(), EventKind::death).events;
    EXPECT_GE(totalOf(lanes.back(), EventKind::death).events,
              static_cast<std::uint64_t>(got.summary.successions));
  }
  EXPECT_GT(deaths, 3);
  EXPECT_GT(noted, 3u);
}

}  // namespace
}  // namespace rayshade
