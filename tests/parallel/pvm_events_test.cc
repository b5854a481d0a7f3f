// Events of programs: over real PVM they add up to the table of the same run; a simulated run is the same picture.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <iterator>
#include <map>
#include <sstream>

#include "rayshade/events/event_file.h"
#include "tests/support/private_machine.h"
#include "tests/support/program.h"

namespace rayshade {
namespace {

constexpr double kPatience = 120;  // seconds
constexpr const char* kTasks = " --schedule hybrid --voxels 2 --pyramids 1 --shades 1 -q -S 1 -R 120 90 ";
constexpr const char* kScene = " scenes/gallery/glass-and-mirrors.ray";

class PvmEvents : public testing::Test {
 protected:
  void SetUp() override {
    if (!PrivateMachine::possible()) GTEST_SKIP() << PrivateMachine::kImpossible;
    std::filesystem::create_directories(scratch_ / "pvm");
    unsetenv("PVMSOCK");
  }
  Finished run(const std::string& command) {
    std::istringstream in(programDirectory() + "/" + command);
    return Program({std::istream_iterator<std::string>(in), {}}, scratch_ / "run",
                   {{"PVM_TMP", scratch_ / "pvm"}, {"PVM_VMID", "test"}})
        .wait(kPatience);
  }
  std::string outputs(const std::string& name) const {
    return "--events " + (scratch_ / name) + ".events --table " + (scratch_ / name) + ".tsv -O " +
           (scratch_ / name) + ".pfm";
  }

  ScratchDirectory scratch_{"pvm-events"};
};

// The rows of a table by task and column.
std::map<std::string, std::map<std::string, std::string>> tableOf(const std::string& text) {
  std::map<std::string, std::map<std::string, std::string>> table;
  std::vector<std::string> names;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream fields(line);
    const std::vector<std::string> values{std::istream_iterator<std::string>(fields), {}};
    if (names.empty()) {
      names = values;
      continue;
    }
    auto& row = table[values[0] + " " + values[1]];
    for (std::size_t i = 0; i < values.size(); ++i) row[names[i]] = values[i];
  }
  return table;
}

void expectThatEventsAddUp(const std::string& eventsFile, const std::string& tableText) {
  const EventFile events = readEvents(eventsFile);
  auto table = tableOf(tableText);
  EXPECT_EQ(events.lanes.size(), table.size());
  for (const EventLane& lane : events.lanes) {
    if (lane.role == "host") continue;
    SCOPED_TRACE(lane.name());
    auto& row = table.at(lane.name());
    const auto& totals = lane.log.totals;
    const auto total = [&](EventKind kind) { return totals[static_cast<std::size_t>(kind)]; };
    EXPECT_EQ(std::to_string(total(EventKind::encode).events), row["packetsOut"]);
    EXPECT_EQ(std::to_string(total(EventKind::encode).amount), row["bytesOut"]);
    EXPECT_EQ(std::to_string(total(EventKind::decode).events), row["packetsIn"]);
    EXPECT_EQ(std::to_string(total(EventKind::decode).count), row["messagesIn"]);
    EXPECT_EQ(std::to_string(total(EventKind::cell).events), row["cacheFetched"]);
    // The record begins when the task has got its first packet.
    const double idle =
        1e-9 * static_cast<double>(total(EventKind::wait).nanoseconds + total(EventKind::idle).nanoseconds);
    EXPECT_LE(idle, std::stod(row["idleSeconds"]) + 1e-3);
    EXPECT_GT(total(EventKind::decode).nanoseconds, 0u);
  }
}

TEST_F(PvmEvents, AddUpToTheTable) {
  const Finished done = run("rayshade-host" + std::string(kTasks) + outputs("real") + kScene);
  ASSERT_EQ(done.status, 0) << done.errors;
  expectThatEventsAddUp(scratch_ / "real.events", readText(scratch_ / "real.tsv"));
  const Finished exported = run("rayshade-events " + (scratch_ / "real.events"));
  EXPECT_EQ(exported.status, 0) << exported.errors;
  EXPECT_NE(exported.output.find("pyramid-trace 0\t0\tencode"), std::string::npos);
  EXPECT_NE(exported.output.find("tag=\"TileDone\""), std::string::npos);
}

// PVM has no part in it, but the programs are here.
TEST_F(PvmEvents, OfASimulatedRunAreThoseOfTheSamePicture) {
  ASSERT_EQ(run("rayshade -q -S 1 -R 120 90 -O " + (scratch_ / "alone.pfm") + kScene).status, 0);
  const std::string simulate = "rayshade-simulate --machine hosts/machines/eight-pcs" + std::string(kTasks);
  for (const char* name : {"first", "second"}) {
    const Finished done = run(simulate + outputs(name) + kScene);
    ASSERT_EQ(done.status, 0) << done.errors;
    EXPECT_EQ(readText(scratch_ / (std::string(name) + ".pfm")), readText(scratch_ / "alone.pfm"));
    expectThatEventsAddUp(scratch_ / (std::string(name) + ".events"),
                          readText(scratch_ / (std::string(name) + ".tsv")));
  }
  EXPECT_EQ(readText(scratch_ / "first.events"), readText(scratch_ / "second.events"));
  EXPECT_EQ(readText(scratch_ / "first.tsv"), readText(scratch_ / "second.tsv"));
  const Finished wrong = run("rayshade-simulate --machine hosts/machines/eight-pcs --processors 9" +
                             std::string(kTasks) + kScene);
  EXPECT_EQ(wrong.status, 1);
  EXPECT_NE(wrong.errors.find("only 8 processors"), std::string::npos) << wrong.errors;
}

TEST_F(PvmEvents, OfThreadsAreTheirTiles) {
  const std::string events = scratch_ / "threads.events";
  ASSERT_EQ(run("rayshade --threads 2 -q -S 1 -R 120 90 --events " + events + " -O " + (scratch_ / "a.pfm") +
                kScene)
                .status,
            0);
  const EventFile file = readEvents(events);
  ASSERT_EQ(file.lanes.size(), 1u);
  EXPECT_EQ(file.lanes[0].log.totals[static_cast<std::size_t>(EventKind::tile)].events, 12u)
      << "tiles of 32 x 32";
  for (const Event& event : file.lanes[0].log.events) EXPECT_LT(event.thread, 2);
}

TEST_F(PvmEvents, OfNobodyAreNotRead) {
  const Finished done = run("rayshade-events scenes/gallery/chess.ray");
  EXPECT_EQ(done.status, 1);
  EXPECT_EQ(done.errors, "rayshade-events: scenes/gallery/chess.ray: is no file of events\n");
}

}  // namespace
}  // namespace rayshade
