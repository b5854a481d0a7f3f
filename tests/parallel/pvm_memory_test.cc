// Memory divides: a model of about 70 MB over real PVM, with limits for the processes of tasks.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "tests/support/private_machine.h"
#include "tests/support/program.h"

namespace rayshade {
namespace {

constexpr double kPatience = 120;     // seconds, for a loaded machine or slow sanitizers
constexpr double kObjects = 597'872;  // of the model

class PvmMemory : public testing::Test {
 protected:
  void SetUp() override {
    if (!PrivateMachine::possible()) GTEST_SKIP() << PrivateMachine::kImpossible;
    std::filesystem::create_directories(scratch_ / "pvm");
    unsetenv("PVMSOCK");
    ASSERT_EQ(std::system((programDirectory() + "/spd balls 6 >" + scene_).c_str()), 0);
  }

  // A small picture of the model; `shell`: commands before, in the same shell.
  Finished render(const std::string& options, const std::string& picture, const std::string& tasks = "",
                  const std::string& shell = "") {
    Program::Environment environment{{"PVM_TMP", scratch_ / "pvm"}, {"PVM_VMID", "test"}};
    if (!tasks.empty()) environment.emplace_back("RAYSHADE_TASKS", tasks);
    const std::string line = shell + "exec " + programDirectory() + "/" + options + " -q -S 1 -R 32 32 -O " +
                             (scratch_ / picture) + " " + scene_;
    return Program({"bash", "-c", line}, scratch_ / "run", environment).wait(kPatience);
  }

  // A directory of task programs of which voxel-trace tasks have a limit.
  std::string limitedTasks(double bytes) {
    const std::string directory = scratch_ / "tasks", program = directory + "/rayshade-voxel-trace";
    std::filesystem::create_directories(directory);
    std::ofstream(program) << "#!/bin/sh\nulimit -d " << static_cast<long>(bytes / 1024) << "\nexec "
                           << programDirectory() << "/rayshade-voxel-trace\n";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    std::filesystem::create_symlink(programDirectory() + "/rayshade-shade", directory + "/rayshade-shade");
    return directory;
  }

  ScratchDirectory scratch_{"pvm-memory"};
  std::string scene_ = scratch_ / "balls.ray";
};

// The numbers of a column of --table, of the voxel-trace tasks.
std::vector<double> columnOf(const std::string& table, const std::string& column) {
  std::vector<double> numbers;
  std::istringstream in(table);
  std::ptrdiff_t position = -1;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    const std::vector<std::string> fields{std::istream_iterator<std::string>(words), {}};
    if (fields.empty() || fields[0] == "#") continue;
    if (position < 0) {
      position = std::find(fields.begin(), fields.end(), column) - fields.begin();
    } else if (fields[0] == "voxel-trace") {
      numbers.push_back(std::stod(fields.at(static_cast<std::size_t>(position))));
    }
  }
  return numbers;
}

TEST_F(PvmMemory, TasksHoldTheirShareAndTakeLittleMoreWhileItIsBuilt) {
  const Finished done =
      render("rayshade-host --schedule data --voxels 4 --table " + (scratch_ / "table.tsv"), "a.pfm");
  ASSERT_EQ(done.status, 0) << done.errors;
  const std::string table = readText(scratch_ / "table.tsv");
  const std::vector<double> model = columnOf(table, "modelBytes"), peak = columnOf(table, "peakMemory"),
                            objects = columnOf(table, "objects");
  ASSERT_EQ(model.size(), 4u);
  double all = 0;
  for (std::size_t i = 0; i < model.size(); ++i) {
    EXPECT_LE(peak[i], 1.25 * (model[i] + 12e6)) << i;
    EXPECT_LE(objects[i], 1.3 * kObjects / 4) << i;
    all += objects[i];
  }
  EXPECT_LE(all, 1.3 * kObjects);
}

TEST_F(PvmMemory, AModelIsRenderedByTasksOfWhichNoneCouldHoldMoreThanAQuarter) {
  constexpr double kQuarter = kObjects * 110 / 4;  // bytes that its objects take
  const std::string tasks = limitedTasks(kQuarter);
  Finished done = render("rayshade-host --schedule data --voxels 8", "b.pfm", tasks);
  EXPECT_EQ(done.status, 0) << done.errors;
  ASSERT_EQ(render("rayshade", "c.pfm").status, 0);
  EXPECT_EQ(readText(scratch_ / "b.pfm"), readText(scratch_ / "c.pfm"));
  done = render("rayshade-host --schedule data --voxels 8 --split equal", "d.pfm", tasks);
  EXPECT_EQ(done.status, 1) << "the limit limits nothing";
  EXPECT_NE(done.errors.find("rayshade-voxel-trace: not enough memory for this task"), std::string::npos)
      << done.errors;
  EXPECT_NE(done.errors.find("its share of the scene: "), std::string::npos) << done.errors;
  EXPECT_NE(done.errors.find("rayshade-host: given up after 3 deaths"), std::string::npos) << done.errors;
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "d.pfm"));
}

TEST_F(PvmMemory, WhatCannotFitIsRefusedBeforeAnythingIsShipped) {
  const auto expectRefused = [&](const Finished& done) {
    EXPECT_EQ(done.status, 1);
    EXPECT_TRUE(done.errors.starts_with("rayshade-host: not enough memory for the scene: its objects take"))
        << done.errors;
    EXPECT_EQ(countLines(done.errors), 1u) << done.errors;
    EXPECT_FALSE(std::filesystem::exists(scratch_ / "e.pfm"));
  };
  const std::string hosts = scratch_ / "hosts";
  std::ofstream(hosts) << "localhost\n# rayshade memory=90 localhost\n";
  expectRefused(render("rayshade-host --voxels 2 --hosts " + hosts, "e.pfm"));
  EXPECT_NE(render("rayshade-host --plan --voxels 2 --hosts " + hosts, "e.pfm")
                .output.find("warning: not enough memory"),
            std::string::npos);
  // A limit of this process is one for each of its tasks.
  expectRefused(render("rayshade-host --voxels 1", "e.pfm", "", "ulimit -d 55000; "));
  std::ofstream(hosts) << "localhost\n\nother sp=0\n";
  const Finished wrong = render("rayshade-host --hosts " + hosts, "e.pfm");
  EXPECT_EQ(wrong.status, 1);
  EXPECT_EQ(wrong.errors.find("rayshade-host: " + hosts + ":3: sp=0"), 0u) << wrong.errors;
}

}  // namespace
}  // namespace rayshade
