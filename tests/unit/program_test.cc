// The program rayshade as a process: how it ends, and what it says on its way.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "tests/support/program.h"
#include "tests/support/scratch_directory.h"

namespace rayshade {
namespace {

namespace fs = std::filesystem;

// Minutes, if nobody ends it.
const std::vector<std::string> kLong{"-R", "3000", "3000", "scenes/gallery/glass-and-mirrors.ray"};

class ProgramAsProcess : public testing::Test {
 protected:
  std::vector<std::string> command(std::vector<std::string> words) const {
    words.insert(words.begin(), programDirectory() + "/rayshade");
    return words;
  }
  std::vector<std::string> longCommand() const {
    std::vector<std::string> words = command(kLong);
    words.insert(words.end(), {"-O", scratch_ / "pictures/a.png"});
    return words;
  }
  bool waitForThePartOfAPicture() const {
    for (int i = 0; i < 1000; ++i) {
      if (!fs::is_empty(scratch_ / "pictures")) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  void SetUp() override { fs::create_directories(scratch_ / "pictures"); }

  ScratchDirectory scratch_{"process"};
};

TEST_F(ProgramAsProcess, DiesOfTheSignalThatInterruptsIt) {
  for (const auto& [signal, name] : {std::pair{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}}) {
    Program program(longCommand(), scratch_ / "program");
    ASSERT_TRUE(waitForThePartOfAPicture());
    kill(program.pid(), signal);
    const Finished done = program.wait(20);
    EXPECT_TRUE(done.inTime);
    EXPECT_EQ(done.status, 128 + signal);
    EXPECT_EQ(done.errors, std::string("rayshade: interrupted by ") + name + "\n");
    EXPECT_TRUE(fs::is_empty(scratch_ / "pictures"));
  }
}

// A shell that loops over scenes stops, because its child died of the signal.
TEST_F(ProgramAsProcess, ALoopOverScenesStops) {
  std::string line;
  for (const std::string& word : longCommand()) line += word + " ";
  Program loop({"setsid", "bash", "-c", "for i in 1 2 3; do echo $i; " + line + "; done"}, scratch_ / "loop");
  ASSERT_TRUE(waitForThePartOfAPicture());
  kill(-loop.pid(), SIGINT);
  const Finished done = loop.wait(20);
  EXPECT_TRUE(done.inTime);
  EXPECT_EQ(done.output, "1\n");
}

TEST_F(ProgramAsProcess, AnIgnoredHangupStaysIgnored) {
  std::vector<std::string> words = command(
      {"-q", "-R", "120", "90", "scenes/gallery/glass-and-mirrors.ray", "-O", scratch_ / "pictures/a.png"});
  words.insert(words.begin(), "nohup");
  Program program(words, scratch_ / "program");
  ASSERT_TRUE(waitForThePartOfAPicture());
  kill(program.pid(), SIGHUP);
  const Finished done = program.wait(60);
  EXPECT_EQ(done.status, 0) << done.errors;
  EXPECT_TRUE(fs::exists(scratch_ / "pictures/a.png"));
}

// It waits for a scene that never comes.
TEST_F(ProgramAsProcess, CanBeInterruptedWhileItReads) {
  const std::string pipe = scratch_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const bool opened : {false, true}) {
    Program program(command({pipe, "-O", scratch_ / "pictures/a.png"}), scratch_ / "program");
    std::fstream writer;
    if (opened) writer.open(pipe);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    ASSERT_TRUE(program.running());
    kill(program.pid(), SIGINT);
    const Finished done = program.wait(10);
    EXPECT_TRUE(done.inTime);
    EXPECT_EQ(done.status, 128 + SIGINT);
  }
}

// A limit of memory that the scene, its acceleration structure, or its picture exceeds.
TEST_F(ProgramAsProcess, SaysWhatThereIsNotEnoughMemoryFor) {
  const std::string scene = scratch_ / "balls.ray", bin = programDirectory();
  const auto limited = [&](int megabytes, const std::string& line) {
    return Program(
               {"bash", "-c", "ulimit -v " + std::to_string(1024 * megabytes) + "; exec " + bin + "/" + line},
               scratch_ / "limited", {{"PVM_TMP", scratch_ / "pvm"}})
        .wait(60);
  };
  ASSERT_EQ(std::system((bin + "/spd balls 5 >" + scene).c_str()), 0);
  std::set<std::string> needs;
  for (int megabytes = 16; megabytes <= 120; megabytes += 4) {
    const Finished done =
        limited(megabytes, "rayshade -R 9 9 " + scene + " -O " + scratch_ / "pictures/a.png");
    if (done.status == 0) break;
    ASSERT_EQ(done.status, 1) << megabytes << done.errors;
    ASSERT_EQ(countLines(done.errors), 1u) << done.errors;
    const std::string begin = "rayshade: not enough memory to ";
    ASSERT_TRUE(done.errors.starts_with(begin)) << done.errors;
    needs.insert(done.errors.substr(begin.size(), done.errors.find(':', begin.size()) - begin.size()));
    EXPECT_NE(done.errors.find(" objects ("), std::string::npos) << done.errors;
    EXPECT_TRUE(fs::is_empty(scratch_ / "pictures"));
  }
  EXPECT_TRUE(needs.contains("read the scene")) << needs.size();
  EXPECT_TRUE(needs.contains("sort the objects of the scene")) << needs.size();
}

TEST_F(ProgramAsProcess, SaysWhereThePictureWent) {
  const std::string picture = scratch_ / "pictures/a.png";
  const Finished done = Program(command({"-v", "-R", "9", "9", "scenes/gallery/chess.ray", "-O", picture}),
                                scratch_ / "program")
                            .wait(60);
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  EXPECT_NE(done.errors.find(std::string("wrote ") + host + ":" + picture + "\n"), std::string::npos)
      << done.errors;
}

}  // namespace
}  // namespace rayshade
