// A large picture as a texture over real PVM: it lies once on the machine, and nothing of it stays.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "tests/support/private_machine.h"
#include "tests/support/program.h"

namespace rayshade {
namespace {

constexpr double kPatience = 120;  // seconds, for a loaded machine or slow sanitizers
constexpr int kSide = 4096;
constexpr const char* kShort = " -S 1 -R 200 200";
constexpr const char* kLong = " -S 3 -R 600 600";  // for somebody to die in the middle of it
constexpr double kPixels = 3.0 * kSide * kSide;    // bytes

class PvmImages : public testing::Test {
 protected:
  void SetUp() override {
    if (!PrivateMachine::possible()) GTEST_SKIP() << PrivateMachine::kImpossible;
    std::filesystem::create_directories(scratch_ / "pvm");
    unsetenv("PVMSOCK");
    std::ofstream picture(scratch_ / "large.ppm", std::ios::binary);
    picture << "P6 " << kSide << " " << kSide << " 255\n";
    std::string row(3 * kSide, ' ');
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < 3 * kSide; ++x)
        row[static_cast<std::size_t>(x)] = static_cast<char>((x / 3 * 5 + x % 3 * 80 + y * 3) >> 2);
      picture << row;
    }
    picture.close();
    std::ofstream(scene_) << "eyep 0 -4 2 lookp 0 0 0 fov 40 light 1 directional 1 -1 1\n"
                             "surface w ambient .1 .1 .1 diffuse .9 .9 .9 reflect .2\n"
                             "sphere w 1 -1 0 0 texture image large.ppm map spherical\n"
                             "sphere w 1 1 0 0 texture image large.ppm map spherical\n"
                             "plane w 0 0 -1 0 0 1\n";
  }
  std::vector<std::string> words(const std::string& program, const std::string& picture) const {
    std::istringstream in(programDirectory() + "/" + program + " -O " + (scratch_ / picture) + " " + scene_);
    return {std::istream_iterator<std::string>(in), {}};
  }
  Program::Environment environment() const { return {{"PVM_TMP", scratch_ / "pvm"}, {"PVM_VMID", "test"}}; }
  Finished run(const std::string& program, const std::string& picture) {
    return Program(words(program, picture), scratch_ / "run", environment()).wait(kPatience);
  }
  std::string sequential(const char* size) {
    EXPECT_EQ(run(std::string("rayshade -q") + size, "sequential.pfm").status, 0);
    return readText(scratch_ / "sequential.pfm");
  }

  ScratchDirectory scratch_{"pvm-images"};
  std::string scene_ = scratch_ / "scene.ray";
};

std::vector<std::vector<std::string>> rowsOf(const std::string& table) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream in(table);
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    if (!line.starts_with('#'))
      rows.emplace_back(std::istream_iterator<std::string>(fields), std::istream_iterator<std::string>{});
  }
  return rows;
}

TEST_F(PvmImages, AreHeldByNoProgramAndSentToNobodyOnTheSameMachine) {
  const std::string expected = sequential(kShort);
  for (const char* schedule : {"--schedule data --voxels 4", "--schedule hybrid", "--schedule demand", ""}) {
    SCOPED_TRACE(schedule);
    const Finished done =
        run(std::string("rayshade-host -q --table ") + (scratch_ / "table.tsv") + " " + schedule + kShort,
            "tasks.pfm");
    ASSERT_EQ(done.status, 0) << done.errors;
    EXPECT_TRUE(readText(scratch_ / "tasks.pfm") == expected) << "the pictures differ";
    const auto rows = rowsOf(readText(scratch_ / "table.tsv"));
    ASSERT_GT(rows.size(), 2u);
    const auto column = [&](const std::vector<std::string>& row, const char* name) {
      return std::stod(row.at(static_cast<std::size_t>(std::ranges::find(rows[0], name) - rows[0].begin())));
    };
    for (std::size_t i = 1; i < rows.size(); ++i) {
      // What a task has looked at of the one copy counts with its own memory, the copy itself does not.
      const double most = rows[i][0] == "host" ? 60e6 : kPixels + 30e6;
      EXPECT_LT(column(rows[i], "peakMemory"), most) << rows[i][0];
      EXPECT_LT(column(rows[i], "modelBytes"), 1e6) << rows[i][0];
      EXPECT_LT(column(rows[i], "bytesIn"), 20e6) << rows[i][0];
    }
    EXPECT_TRUE(std::filesystem::is_empty(scratch_ / "pvm"));
  }
}

TEST_F(PvmImages, ASuccessorFindsThemAgain) {
  const std::string expected = sequential(kLong);
  Program host(words(std::string("rayshade-host -q --schedule data --voxels 2") + kLong, "tasks.pfm"),
               scratch_ / "run", environment());
  const std::string mark = "PVM_TMP=" + (scratch_ / "pvm");
  pid_t victim = 0;
  for (int i = 0; i < 3000 && victim == 0 && host.running(); ++i) {
    for (pid_t pid : processesWith(mark, "rayshade-voxel-trace"))
      if (cpuSecondsOf(pid).value_or(0) > 0.02) victim = pid;
    usleep(2'000);
  }
  ASSERT_NE(victim, 0) << "the render was too short";
  ::kill(victim, SIGKILL);
  const Finished done = host.wait(kPatience);
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_TRUE(readText(scratch_ / "tasks.pfm") == expected) << "the pictures differ";
  EXPECT_TRUE(std::filesystem::is_empty(scratch_ / "pvm"));
}

TEST_F(PvmImages, NothingIsLeftAfterAKill) {
  Program host(words(std::string("rayshade-host -q --schedule data --voxels 2") + kLong, "tasks.pfm"),
               scratch_ / "run", environment());
  const std::string mark = "PVM_TMP=" + (scratch_ / "pvm");
  for (int i = 0; i < 3000 && processesWith(mark, "rayshade-voxel-trace").empty(); ++i) usleep(2'000);
  ::kill(host.pid(), SIGKILL);
  host.wait(kPatience);
  for (int i = 0; i < 150 && !processesWith(mark).empty(); ++i) usleep(100'000);
  EXPECT_TRUE(processesWith(mark).empty());
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scratch_.path()))
    EXPECT_TRUE(!entry.is_regular_file() || entry.path().filename() == "large.ppm" ||
                entry.file_size() < 1'000'000)
        << entry.path();
}

}  // namespace
}  // namespace rayshade
