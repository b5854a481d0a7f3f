// Records of events: bounded, counted, written, read and exported.
// guarded: reads bytes of others
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>

#include "rayshade/events/event_export.h"
#include "tests/support/program.h"
#include "tests/support/scratch_directory.h"

namespace rayshade {
namespace {

EventRecord someRecord(std::size_t most, std::uint16_t thread = 0) {
  EventRecord record(most, thread);
  for (std::uint32_t i = 0; i < 10; ++i) {
    const std::uint64_t begin = 1000'000 * (i + 1);
    record.add({begin, begin + 1000, EventKind::encode, 0, 7, i, 2, 100});
    record.add({begin + 2000, begin + 5000, EventKind::trace});
  }
  return record;
}

EventFile someFile() {
  EventFile file{{"Forget", "Items"}, {}};
  EventRecord receiver(100);
  receiver.add({2'000'000, 2'001'000, EventKind::decode, 0, 3, 0, 2, 100});
  receiver.at(0.0025, EventKind::queue, 0, 0, 12, 0);
  receiver.at(0.0026, EventKind::death, 99, 0, 0, 0);
  EventRecord sender = someRecord(100);
  sender.at(0.001, EventKind::content, 7, 1, 2, 95);
  file.lanes.push_back({3, "voxel-trace", 0, "node \"1\"", 0, sender.log()});
  file.lanes.push_back({7, "shade", 1, "node2", -500'000, receiver.log()});
  return file;
}

void writeText(const std::string& name, const std::string& text) {
  std::ofstream(name, std::ios::binary) << text;
}

void write(const std::string& name, const EventFile& file) {
  std::FILE* const to = std::fopen(name.c_str(), "w");
  ASSERT_NE(to, nullptr);
  writeHead(to, file.messages);
  for (const EventLane& lane : file.lanes) writeLane(to, lane);
  std::fclose(to);
}

TEST(Events, TheLatestAreKeptAndAllAreCounted) {
  const EventLog log = someRecord(6).log();
  EXPECT_EQ(log.events.size(), 6u);
  EXPECT_EQ(log.dropped, 14u);
  EXPECT_EQ(log.events.front().number, 7u);
  EXPECT_EQ(log.events.back().kind, EventKind::trace);
  for (std::size_t i = 1; i < log.events.size(); ++i) EXPECT_GE(log.events[i].end, log.events[i - 1].end);
  EXPECT_EQ(log.totals[static_cast<int>(EventKind::encode)], (EventTotal{10, 10'000, 20, 1000}));
  EXPECT_EQ(someRecord(0).log().dropped, 20u);
}

TEST(Events, BareSpansThatFollowCloselyAreOne) {
  EventRecord record(10);
  record.span(EventKind::idle, 1, 2);
  record.span(EventKind::idle, 2.000001, 3);
  record.span(EventKind::idle, 4, 5);
  record.span(EventKind::wait, 5, 6);
  const EventLog log = record.log();
  ASSERT_EQ(log.events.size(), 3u);
  EXPECT_EQ(log.events[0].end, 3'000'000'000u);
  EXPECT_EQ(log.totals[static_cast<int>(EventKind::idle)].events, 3u);
}

TEST(Events, ThreadsAreJoinedInTheOrderOfTime) {
  EventLog log = someRecord(100).log();
  log.join(someRecord(100, 1).log());
  EXPECT_EQ(log.events.size(), 40u);
  EXPECT_EQ(log.totals[static_cast<int>(EventKind::encode)].amount, 2000u);
  for (std::size_t i = 1; i < log.events.size(); ++i) EXPECT_GE(log.events[i].end, log.events[i - 1].end);
}

TEST(Events, AFileIsReadAsItWasWritten) {
  const ScratchDirectory scratch("events");
  const EventFile file = someFile();
  write(scratch / "events", file);
  const EventFile read = readEvents(scratch / "events");
  EXPECT_EQ(read.messages, file.messages);
  ASSERT_EQ(read.lanes.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read.lanes[i].name(), file.lanes[i].name());
    EXPECT_EQ(read.lanes[i].clock, file.lanes[i].clock);
    EXPECT_EQ(read.lanes[i].log.totals, file.lanes[i].log.totals);
    EXPECT_EQ(read.lanes[i].log.events, file.lanes[i].log.events);
  }
}

TEST(Events, AFileThatIsCutOrDamagedIsSaidToBe) {
  const ScratchDirectory scratch("events");
  write(scratch / "events", someFile());
  const std::string whole = readText(scratch / "events");
  std::size_t refused = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    writeText(scratch / "cut", whole.substr(0, size));
    try {
      EXPECT_LT(readEvents(scratch / "cut").lanes.size(), 2u) << size;
    } catch (const std::runtime_error& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find("cut: "), std::string::npos);
    }
  }
  EXPECT_GT(refused, whole.size() - 10);
  std::string damaged = whole;
  for (std::size_t at = 18; at < whole.size(); at += 3) {
    damaged[at] = '\xff';
    writeText(scratch / "damaged", damaged);
    try {
      readEvents(scratch / "damaged");
    } catch (const std::runtime_error&) {
    }
    damaged[at] = whole[at];
  }
}

std::string exported(const std::function<void(std::FILE*, const EventFile&)>& write) {
  const ScratchDirectory scratch("events");
  std::FILE* const to = std::fopen((scratch / "out").c_str(), "w");
  write(to, someFile());
  std::fclose(to);
  return readText(scratch / "out");
}

TEST(Events, ExportsSayWhatIsInTheFile) {
  const std::string tsv = exported(writeTsv);
  EXPECT_NE(tsv.find("# total\tvoxel-trace 0\tencode\t10\t"), std::string::npos) << tsv;
  EXPECT_NE(tsv.find("\tto=\"shade 1\"\ttag=\"Items\"\tmessages=2\tbytes=95"), std::string::npos) << tsv;
  // The clock of the second lane is half a millisecond ahead.
  EXPECT_NE(tsv.find("shade 1\t0\tdecode\t0.000500000\t0.000501000\tfrom=\"voxel-trace 0\""),
            std::string::npos)
      << tsv;
  const std::string json = exported(writePerfetto);
  EXPECT_NE(json.find("\"id\":\"3>7.0\""), std::string::npos);
  EXPECT_EQ(json.find("\"id\":\"3>7.0\"") == json.rfind("\"id\":\"3>7.0\""), false) << "a flow has two ends";
  EXPECT_NE(json.find("node \\\"1\\\""), std::string::npos);
  EXPECT_EQ(std::count(json.begin(), json.end(), '{'), std::count(json.begin(), json.end(), '}'));
  const std::string paje = exported(writePaje);
  EXPECT_NE(paje.find("5 0.000000000 Does L0.0 encode"), std::string::npos) << paje;
  EXPECT_NE(paje.find("7 0.001000000 Waits L1.0 12"), std::string::npos) << paje;
}

}  // namespace
}  // namespace rayshade
