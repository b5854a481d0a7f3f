// PVM's own console, as a user types into it: where the picture went, clear words, and nothing that is left behind.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/support/console.h"
#include "tests/support/lab.h"
#include "tests/support/private_machine.h"

namespace rayshade {
namespace {

namespace fs = std::filesystem;

constexpr double kPatience = 60;  // seconds, for a loaded machine

class PvmConsole : public testing::Test {
 protected:
  void SetUp() override {
    if (!PrivateMachine::possible()) GTEST_SKIP() << PrivateMachine::kImpossible;
    unsetenv("PVMSOCK");
    fs::create_directories(scratch_ / "pvm");
    fs::create_directories(scratch_ / "pictures");
  }
  void TearDown() override {
    for (const pid_t pid : processesWith(mark_)) {
      ADD_FAILURE() << "process " << pid
                    << " is left: " << readText("/proc/" + std::to_string(pid) + "/cmdline");
      kill(pid, SIGKILL);
    }
  }
  Console start() const {
    return Console({"pvm", "-nlocalhost"}, {{"PVM_TMP", scratch_ / "pvm"},
                                            {"PVM_VMID", "console"},
                                            {"PVM_ALLOW_ROOT", "1"},
                                            {"HOME", scratch_ / "pictures"}});
  }
  // What a spawned program says until it has ended.
  static std::string spawn(Console& console, const std::string& command) {
    console.type("spawn " + command);
    return console.hear("] finished", kPatience);
  }
  std::string host(const std::string& arguments) const {
    return programDirectory() + "/rayshade-host " + arguments;
  }
  bool soon(const std::function<bool()>& what) const {
    for (int i = 0; i < 1000 && !what(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return what();
  }
  std::vector<std::string> pictures() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(scratch_ / "pictures"))
      names.push_back(entry.path().filename());
    return names;
  }
  // Nothing of the virtual machine but the log of its daemon, which is PVM's.
  void expectNothingLeft() {
    EXPECT_TRUE(soon([this] { return processesWith(mark_).empty(); }));
    for (const auto& entry : fs::directory_iterator(scratch_ / "pvm"))
      EXPECT_TRUE(entry.path().filename().string().starts_with("pvml.")) << entry.path();
    EXPECT_EQ(pictures(), std::vector<std::string>{}) << "pictures that nobody has finished";
  }

  ScratchDirectory scratch_{"console"};
  std::string mark_ = "PVM_TMP=" + scratch_ / "pvm";
  const std::string chess_ = fs::absolute("scenes/gallery/chess.ray");
  const std::string small_ = "-S 1 -R 20 15 " + chess_;
  const std::string long_ =
      "--voxels 2 -R 3000 3000 " + fs::absolute("scenes/gallery/glass-and-mirrors.ray").string();
};

bool says(const std::string& all, const std::string& part) { return all.find(part) != std::string::npos; }

TEST_F(PvmConsole, SaysWherePicturesWentAndWhatIsWrong) {
  Console console = start();
  ASSERT_TRUE(says(console.hear("pvm> ", kPatience), "pvm> "));
  console.type("conf");
  EXPECT_TRUE(says(console.hear("1 host", kPatience), "1 host"));
  char name[256] = {};
  gethostname(name, sizeof name - 1);
  const std::string there = std::string("wrote ") + name + ":" + scratch_ / "pictures/";

  const std::string absolute = spawn(console, "-> " + host("-O " + scratch_ / "pictures/a.png " + small_));
  EXPECT_TRUE(says(absolute, there + "a.png")) << absolute;
  EXPECT_TRUE(says(absolute, "picture checksum")) << absolute;
  const std::string relative = spawn(console, "-> " + host("-O b.png " + small_));  // at home
  EXPECT_TRUE(says(relative, there + "b.png")) << relative;
  fs::create_directories(scratch_ / "pictures/c");
  const std::string elsewhere =
      spawn(console, "-localhost:" + scratch_ / "pictures/c" + " -> " + host("-O c.png " + small_));
  EXPECT_TRUE(says(elsewhere, there + "c/c.png")) << elsewhere;
  for (const char* file : {"a.png", "b.png", "c/c.png"})
    EXPECT_TRUE(fs::exists(scratch_ / "pictures/" + file)) << file;

  const std::string missing = spawn(console, "-> " + host("-O d.png no-such.ray"));
  EXPECT_TRUE(says(missing, "no-such.ray: error: cannot be read")) << missing;
  EXPECT_TRUE(says(missing, "looked for in " + scratch_ / "pictures")) << missing;
  const std::string nowhere = spawn(console, "-> " + host(small_));
  EXPECT_TRUE(says(nowhere, "shows no pictures")) << nowhere;
  const std::string nonsense = spawn(console, "-> " + host("--voxels none " + small_));
  EXPECT_TRUE(says(nonsense, "`none` is not a whole number")) << nonsense;
  for (const std::string task : {"voxel-trace", "pyramid-trace", "shade"}) {
    const std::string byHand = spawn(console, "-> " + programDirectory() + "/rayshade-" + task);
    EXPECT_TRUE(says(byHand, "rayshade-" + task + ": rayshade-host starts this program")) << byHand;
  }
  EXPECT_EQ(pictures().size(), 3u);
  for (const char* file : {"a.png", "b.png", "c"}) fs::remove_all(scratch_ / "pictures/" + file);
  console.type("halt");
  EXPECT_TRUE(console.ends(kPatience));
  expectNothingLeft();
}

TEST_F(PvmConsole, ResetAndHaltInTheMiddleOfARenderLeaveNothing) {
  Console console = start();
  ASSERT_TRUE(says(console.hear("pvm> ", kPatience), "pvm> "));
  const auto render = [&] {
    console.type("spawn -> " + host("-O a.png " + long_));
    EXPECT_TRUE(says(console.hear(" %  row ", kPatience), " %  row ")) << "no progress";
    EXPECT_EQ(pictures().size(), 1u);
  };
  render();
  console.type("ps -a");
  const std::string tasks = console.hear("rayshade-shade", kPatience);
  EXPECT_TRUE(says(tasks, "rayshade-voxel-trace") && says(tasks, "rayshade-host")) << tasks;
  console.type("reset");
  const std::string reset = console.hear("] finished", kPatience);
  EXPECT_TRUE(says(reset, "rayshade-host: interrupted by SIGTERM")) << reset;
  EXPECT_EQ(pictures().size(), 0u);
  render();
  console.type("halt");
  EXPECT_TRUE(console.ends(kPatience));
  expectNothingLeft();
}

TEST_F(PvmConsole, AHostThatIsAddedHelpsAndOneThatIsDeletedIsReplaced) {
  if (geteuid() != 0) GTEST_SKIP() << "pretend hosts need root";
  Lab lab("rc" + std::to_string(getpid() % 1000), scratch_ / "lab");
  if (const Finished up = lab.run("up 2"); up.status != 0)
    GTEST_SKIP() << "no network namespaces here: " << up.errors;
  Console console({"hosts/lab", "run", lab.host(1), "pvm", "-n" + lab.host(1)},
                  {{"RAYSHADE_LAB", lab.name()}});
  ASSERT_TRUE(says(console.hear("pvm> ", kPatience), "pvm> "));
  console.type("add " + lab.host(2));
  EXPECT_TRUE(says(console.hear("1 successful", kPatience), "1 successful"));
  console.type("conf");
  EXPECT_TRUE(says(console.hear("2 hosts", kPatience), "2 hosts"));
  const std::string picture = scratch_ / "pictures/a.png";
  console.type("spawn -" + lab.host(1) + " -> " +
               host("--voxels 4 -R 400 300 -S 2 " +
                    fs::absolute("scenes/gallery/glass-and-mirrors.ray").string() + " -O " + picture));
  EXPECT_TRUE(soon([&] { return lab.busy(2); })) << "nothing runs on the host that was added";
  console.type("delete " + lab.host(2));
  const std::string rest = console.hear("] finished", kPatience);
  EXPECT_TRUE(says(rest, "died and were replaced")) << rest;
  EXPECT_TRUE(says(rest, "wrote " + lab.host(1) + ":" + picture)) << rest;
  EXPECT_TRUE(fs::exists(picture));
  console.type("halt");
  EXPECT_TRUE(console.ends(kPatience));
  EXPECT_TRUE(
      soon([&] { return processesWith("PVM_TMP=/tmp/rayshade-" + lab.name() + "/" + lab.host(1)).empty(); }));
}

}  // namespace
}  // namespace rayshade
