// The programs as a user runs them, over real PVM: each test has a virtual machine of its own.
//
// A process belongs to a test when PVM_TMP in its environment is the directory of the test: so those that are to
// die are found, and those that should be gone.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <sstream>
#include <thread>

#include "tests/support/lab.h"
#include "tests/support/private_machine.h"
#include "tests/support/program.h"

namespace rayshade {
namespace {

constexpr double kPatience = 120;  // seconds, for a loaded machine or slow sanitizers
constexpr uid_t kOrdinaryUser = 65534;

bool waitFor(const std::function<bool()>& what, double seconds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < deadline) {
    if (what()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return what();
}

class Pvm : public testing::Test {
 protected:
  void SetUp() override {
    if (!PrivateMachine::possible()) GTEST_SKIP() << PrivateMachine::kImpossible;
    for (const char* program : {"rayshade", "rayshade-host", "rayshade-voxel-trace", "rayshade-shade"})
      ASSERT_TRUE(std::filesystem::exists(programDirectory() + "/" + program))
          << programDirectory() << ": set RAYSHADE_BIN to where the programs are";
    std::filesystem::create_directories(scratch_ / "pvm");
    unsetenv("PVMSOCK");  // set, even to nothing, it would be taken for a daemon
  }
  void TearDown() override {
    EXPECT_TRUE(waitFor([this] { return mine().empty(); }, 10)) << "processes are left";
    for (pid_t pid : mine()) kill(pid, SIGKILL);
  }

  std::vector<pid_t> mine(const std::string& program = "") const { return processesWith(mark_, program); }
  std::string scratch(const std::string& file) const { return scratch_ / file; }
  Program::Environment environment() const { return {{"PVM_TMP", scratch_ / "pvm"}, {"PVM_VMID", "test"}}; }

  std::string sequential(const std::string& arguments, const std::string& picture) {
    Finished done =
        Program(words(programDirectory() + "/rayshade -q " + arguments + " -O " + scratch(picture)),
                scratch("sequential"))
            .wait(kPatience);
    EXPECT_EQ(done.status, 0) << done.errors;
    return readText(scratch(picture));
  }
  std::unique_ptr<Program> startHost(const std::string& arguments, const std::string& picture,
                                     const Program::Environment& more = {}) {
    Program::Environment all = environment();
    all.insert(all.end(), more.begin(), more.end());
    return std::make_unique<Program>(
        words(programDirectory() + "/rayshade-host " + arguments + " -O " + scratch(picture)),
        scratch("host"), all);
  }
  static std::vector<std::string> words(const std::string& line) {
    std::istringstream in(line);
    return {std::istream_iterator<std::string>(in), {}};
  }
  // No picture, and nothing that was going to be one.
  void expectNoPicture(const std::string& picture) {
    for (const auto& entry : std::filesystem::directory_iterator(scratch_.path()))
      EXPECT_EQ(entry.path().filename().string().find(picture.substr(0, picture.find('.'))),
                std::string::npos)
          << entry.path() << " is left";
  }
  void expectOneMessage(const Finished& done, int status) {
    EXPECT_TRUE(done.inTime);
    EXPECT_EQ(done.status, status) << done.errors;
    EXPECT_EQ(countLines(done.errors), 1u) << done.errors;
    EXPECT_GT(done.errors.size(), 20u);
  }
  // A voxel-trace or shade task that is in the middle of the render.
  std::optional<pid_t> busyTask(const std::string& program) {
    std::optional<pid_t> found;
    waitFor(
        [&] {
          for (pid_t pid : mine(program))
            if (cpuSecondsOf(pid).value_or(0) > 0.05) found = pid;
          return found.has_value();
        },
        30);
    return found;
  }

  ScratchDirectory scratch_{"pvm-test"};
  std::string mark_ = "PVM_TMP=" + scratch_ / "pvm";
};

// Long enough for somebody to die in the middle of it.
constexpr const char* kLong = "-R 200 150 -S 3 -T 0 0 0 scenes/gallery/glass-and-mirrors.ray";

TEST_F(Pvm, APlanForHostsThatAreNotThereStartsNothing) {
  std::ofstream(scratch("hosts")) << "localhost\nno-such-host.invalid sp=2000\n";
  const Finished done =
      startHost("--plan --voxels 4 --hosts " + scratch("hosts") + " scenes/gallery/chess.ray", "plan.png")
          ->wait(kPatience);
  EXPECT_EQ(done.status, 0) << done.errors;
  EXPECT_NE(done.output.find("voxel-trace 3"), std::string::npos) << done.output;
  EXPECT_NE(done.output.find("no-such-host.invalid"), std::string::npos) << done.output;
  EXPECT_TRUE(std::filesystem::is_empty(scratch_ / "pvm"));
  expectNoPicture("plan.png");
}

TEST_F(Pvm, TheTableOfTheTasksIsWrittenToAFile) {
  const Finished done =
      startHost("--table " + scratch("table.tsv") + " --voxels 2 -q -R 20 15 scenes/gallery/chess.ray",
                "a.png")
          ->wait(kPatience);
  EXPECT_EQ(done.status, 0) << done.errors;
  EXPECT_EQ(done.errors, "");
  const std::string table = readText(scratch("table.tsv"));
  EXPECT_NE(table.find("\nvoxel-trace\t1\tlocalhost\t"), std::string::npos) << table;
  EXPECT_NE(table.find("# checksum\t"), std::string::npos) << table;
}

TEST_F(Pvm, PicturesAreThoseOfTheSequentialProgramByteForByte) {
  struct Case {
    const char *scene, *tasks, *picture;
  };
  for (const Case& c : {Case{"-S 1 -R 80 60 scenes/gallery/chess.ray", "--voxels 1 --shades 1", "a.png"},
                        Case{"-S 1 -R 80 60 scenes/gallery/chess.ray", "--voxels 5 --shades 2", "b.pfm"},
                        Case{"-S 1 -R 60 60 scenes/gallery/glass-and-mirrors.ray",
                             "--voxels 4 --shades 3 --window 50", "c.pfm"},
                        Case{"-S 1 -R 60 40 scenes/gallery/nautilus.ray",
                             "--voxels 3 --voxels-per-task 2 --split cost", "d.ppm"},
                        Case{"-S 1 -R 60 40 scenes/gallery/pavilion.ray", "", "e.png"}}) {
    SCOPED_TRACE(std::string(c.scene) + " " + c.tasks);
    const std::string expected = sequential(c.scene, std::string("sequential-") + c.picture);
    const Finished done = startHost(std::string("-q ") + c.tasks + " " + c.scene, c.picture)->wait(kPatience);
    ASSERT_EQ(done.status, 0) << done.errors;
    EXPECT_TRUE(readText(scratch(c.picture)) == expected) << "the pictures differ";
    EXPECT_EQ(done.errors, "") << "-q says nothing";
  }
}

TEST_F(Pvm, FramesOfAnAnimationAreThoseOfTheSequentialProgram) {
  const std::string scene = "-N 3 tests/data/suite/anim-b.ray -R 60 45";
  sequential(scene, "one.png");
  const Finished done = startHost("-q --voxels 3 " + scene, "many.png")->wait(kPatience);
  ASSERT_EQ(done.status, 0) << done.errors;
  for (const char* number : {".0000.png", ".0001.png", ".0002.png"}) {
    EXPECT_NE(readText(scratch(std::string("one") + number)), "");
    EXPECT_TRUE(readText(scratch(std::string("one") + number)) ==
                readText(scratch(std::string("many") + number)))
        << number;
  }
}

TEST_F(Pvm, AKilledTaskIsReplacedAndThePictureIsTheSame) {
  const std::string expected = sequential(kLong, "sequential.pfm");
  for (const auto& [victim, shading] : {std::pair{"rayshade-voxel-trace", "separate"},
                                        {"rayshade-shade", "separate"},
                                        {"rayshade-voxel-trace", "local"}}) {
    SCOPED_TRACE(std::string(victim) + " " + shading);
    const auto host =
        startHost(std::string("--voxels 3 --shades 2 --shading ") + shading + " " + kLong, "picture.pfm");
    const auto pid = busyTask(victim);
    ASSERT_TRUE(pid.has_value() && host->running()) << "the render was too short";
    kill(*pid, SIGKILL);
    const Finished done = host->wait(kPatience);
    ASSERT_EQ(done.status, 0) << done.errors;
    EXPECT_TRUE(readText(scratch("picture.pfm")) == expected) << "the pictures differ";
    EXPECT_NE(done.errors.find("1 tasks died and were replaced"), std::string::npos) << done.errors;
  }
}

TEST_F(Pvm, AStoppedTaskIsReplacedToo) {
  const std::string expected = sequential(kLong, "sequential.pfm");
  const auto host = startHost(std::string("--patience 3 --voxels 3 --shades 1 ") + kLong, "picture.pfm");
  const auto pid = busyTask("rayshade-voxel-trace");
  ASSERT_TRUE(pid.has_value());
  kill(*pid, SIGSTOP);
  const Finished done = host->wait(kPatience);
  EXPECT_EQ(done.status, 0) << done.errors;
  bool gone = false;  // although it never went on
  for (int i = 0; i < 50 && !gone; ++i) {
    gone = kill(*pid, 0) != 0;
    if (!gone) usleep(100'000);
  }
  EXPECT_TRUE(gone);
  if (!gone) kill(*pid, SIGKILL);
  EXPECT_TRUE(readText(scratch("picture.pfm")) == expected) << "the pictures differ";
}

TEST_F(Pvm, AKilledDaemonEndsTheRenderWithAMessage) {
  const auto host = startHost(std::string("-q --voxels 2 ") + kLong, "picture.pfm");
  ASSERT_TRUE(busyTask("rayshade-voxel-trace").has_value());
  std::vector<pid_t> daemons = mine("pvmd3");
  if (daemons.empty()) daemons = mine("pvmd");
  ASSERT_FALSE(daemons.empty());
  for (pid_t pid : daemons) kill(pid, SIGKILL);
  const Finished done = host->wait(kPatience);
  EXPECT_TRUE(done.inTime);
  EXPECT_EQ(done.status, 1) << done.errors;
  EXPECT_NE(done.errors, "");
  expectNoPicture("picture.pfm");
}

TEST_F(Pvm, AKilledHostProgramLeavesNothingRunning) {
  const auto host = startHost(std::string("-q --voxels 2 ") + kLong, "picture.pfm");
  ASSERT_TRUE(busyTask("rayshade-voxel-trace").has_value());
  kill(host->pid(), SIGKILL);
  host->wait(kPatience);
  EXPECT_TRUE(waitFor([this] { return mine().empty(); }, 15));
}

TEST_F(Pvm, InterruptionsEndInOrder) {
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const auto host = startHost(std::string("-q --voxels 2 ") + kLong, "picture.pfm");
    ASSERT_TRUE(busyTask("rayshade-voxel-trace").has_value());
    kill(host->pid(), signal);
    expectOneMessage(host->wait(kPatience), 128 + signal);  // by it, not an exit of its own
    expectNoPicture("picture.pfm");
    EXPECT_TRUE(std::filesystem::is_empty(scratch_ / "pvm"));
    EXPECT_TRUE(waitFor([this] { return mine().empty(); }, 10)) << "processes are left";
  }
}

// A limit of memory that the host program itself exceeds; of tasks: pvm_memory_test.cc.
TEST_F(Pvm, WhatThereIsNotEnoughMemoryForIsSaid) {
  const std::string scene = scratch("balls.ray");
  ASSERT_EQ(std::system((programDirectory() + "/spd balls 5 >" + scene).c_str()), 0);
  bool inHost = false;
  for (int megabytes = 14; megabytes <= 120; megabytes += 4) {
    const std::string line = "ulimit -v " + std::to_string(1024 * megabytes) + "; exec " +
                             programDirectory() + "/rayshade-host -q -R 9 9 " + scene + " -O " +
                             scratch("picture.png");
    const Finished done = Program({"bash", "-c", line}, scratch("limited"), environment()).wait(kPatience);
    if (done.status == 0) break;
    ASSERT_EQ(done.status, 1) << megabytes << " MB: " << done.errors;
    inHost = inHost ||
             done.errors.starts_with("rayshade-host: not enough memory to read the scene: the scene has ");
    expectNoPicture("picture.png");
  }
  EXPECT_TRUE(inHost);
}

// The daemon needs two descriptors for each task.
TEST_F(Pvm, MoreTasksThanFilesMayBeOpenIsSaid) {
  {
    std::ofstream scene(scratch("row.ray"));
    for (int i = 0; i < 200; ++i) scene << "sphere 0.1 " << i << " 0 0\n";
  }
  const Finished done =
      Program(words("prlimit --nofile=64 " + programDirectory() + "/rayshade-host " + scratch("row.ray") +
                    " -R 16 16 --voxels 126 --shades 2 -O " + scratch("many.ppm")),
              scratch("host"), environment())
          .wait(kPatience);
  EXPECT_TRUE(done.inTime);
  EXPECT_EQ(done.status, 1);
  EXPECT_NE(done.errors.find("ulimit -n"), std::string::npos) << done.errors;
  expectNoPicture("many.ppm");
  EXPECT_TRUE(std::filesystem::is_empty(scratch("pvm")));
}

TEST_F(Pvm, MissingTaskProgramsAreNamed) {
  std::filesystem::create_directories(scratch("empty"));
  const Finished done = startHost("-q -S 1 -R 20 20 scenes/gallery/chess.ray", "picture.png",
                                  {{"RAYSHADE_TASKS", scratch("empty")}})
                            ->wait(kPatience);
  expectOneMessage(done, 1);
  EXPECT_NE(done.errors.find("rayshade-voxel-trace"), std::string::npos) << done.errors;
  expectNoPicture("picture.png");
}

TEST_F(Pvm, HostsThatDoNotJoinAreNamed) {
  std::ofstream(scratch("hosts")) << "no-such-host.invalid\n";
  const Finished done =
      startHost("-q --hosts " + scratch("hosts") + " -S 1 -R 20 20 scenes/gallery/chess.ray", "picture.png")
          ->wait(kPatience);
  expectOneMessage(done, 1);
  EXPECT_NE(done.errors.find("no-such-host.invalid"), std::string::npos) << done.errors;
  expectNoPicture("picture.png");

  const auto allowed =
      startHost("-q --missing-hosts --hosts " + scratch("hosts") + " -S 1 -R 20 20 scenes/gallery/chess.ray",
                "allowed.png");
  const Finished rendered = allowed->wait(kPatience);
  EXPECT_EQ(rendered.status, 0) << rendered.errors;
  EXPECT_TRUE(readText(scratch("allowed.png")) ==
              sequential("-S 1 -R 20 20 scenes/gallery/chess.ray", "sequential.png"));
}

TEST_F(Pvm, WhatCannotBeDoneIsSaidBeforeAnythingIsStarted) {
  expectOneMessage(startHost("-q -S 1 -R 20 20 scenes/gallery/chess.ray", "no/such/directory/picture.png")
                       ->wait(kPatience),
                   1);
  EXPECT_TRUE(mine().empty());
  std::ofstream(scratch("wrong.ray")) << "screen 20 20\nspheres 1 0 0 0\n";
  const Finished wrong = startHost("-q " + scratch("wrong.ray"), "picture.png")->wait(kPatience);
  EXPECT_EQ(wrong.status, 1);
  EXPECT_NE(wrong.errors.find("wrong.ray:2:"), std::string::npos) << wrong.errors;
  std::ofstream(scratch("nothing.ray")) << "screen 20 20\n";
  expectOneMessage(startHost("-q " + scratch("nothing.ray"), "picture.png")->wait(kPatience), 1);
  EXPECT_EQ(startHost("--voxels 0 scenes/gallery/chess.ray", "picture.png")->wait(kPatience).status, 2);
  EXPECT_EQ(startHost("--no-such-option scenes/gallery/chess.ray", "picture.png")->wait(kPatience).status, 2);
  expectNoPicture("picture.png");
}

TEST_F(Pvm, AnOrdinaryUserCanDoItToo) {
  if (geteuid() != 0) GTEST_SKIP() << "the other tests run as an ordinary user already";
  if (std::system("command -v setpriv > /dev/null") != 0) GTEST_SKIP() << "setpriv is not installed";
  const std::string directory = scratch_ / "user";
  std::filesystem::create_directories(directory + "/pvm");
  for (const std::string& path : {directory, directory + "/pvm"})
    ASSERT_EQ(chown(path.c_str(), kOrdinaryUser, kOrdinaryUser), 0);
  const std::string id = std::to_string(kOrdinaryUser);
  const std::string become = "setpriv --reuid " + id + " --regid " + id + " --clear-groups ";
  for (const std::string& reach :
       {"-x " + programDirectory() + "/rayshade-host", "-w " + directory + "/pvm"}) {
    if (Program(words(become + "test " + reach), scratch("probe")).wait(10).status != 0)
      GTEST_SKIP() << "an ordinary user cannot reach " << reach.substr(3);
  }
  const std::string expected = sequential("-S 1 -R 60 60 scenes/gallery/chess.ray", "sequential.png");
  Program host(words(become + programDirectory() +
                     "/rayshade-host -q --voxels 2 -S 1 -R 60 60 scenes/gallery/chess.ray -O " + directory +
                     "/picture.png"),
               scratch("host"), {{"PVM_TMP", directory + "/pvm"}, {"PVM_VMID", "test"}, {"HOME", directory}});
  const Finished done = host.wait(kPatience);
  EXPECT_EQ(done.status, 0) << done.errors;
  EXPECT_TRUE(readText(directory + "/picture.png") == expected);
  EXPECT_TRUE(waitFor([&] { return processesWith("PVM_TMP=" + directory + "/pvm").empty(); }, 10));
}

TEST_F(Pvm, SeveralHostsAndTheCrashOfOne) {
  if (geteuid() != 0) GTEST_SKIP() << "pretend hosts need root";
  const std::string expected = sequential(kLong, "sequential.pfm");
  // A packet that the crash catches in its sending stays in PVM's daemon and delays all others for minutes (see
  // pvm_link.h).  That is rare: of a few crashes one at least is got over quickly.
  constexpr int kCrashes = 3;
  constexpr double kQuickly = 45;  // seconds for a render that takes 5 undisturbed
  bool quick = false;
  for (int crash = 0; crash < kCrashes && !quick; ++crash) {
    Lab lab("rt" + std::to_string(getpid() % 1000), scratch("lab"));
    if (const Finished up = lab.run("up 3"); up.status != 0)
      GTEST_SKIP() << "no network namespaces here: " << up.errors;
    const Finished started = lab.run("start ep=" + programDirectory());
    ASSERT_EQ(started.status, 0) << started.errors << started.output;
    const auto render = [&](const std::string& picture) {
      return lab.begin("run " + lab.host(1) + " " + programDirectory() +
                       "/rayshade-host --schedule data --voxels 6 --shades 3 " + kLong + " -O " +
                       scratch(picture));
    };
    if (crash == 0) {
      const Finished calm = render("calm.pfm")->wait(kPatience);
      ASSERT_EQ(calm.status, 0) << calm.errors;
      EXPECT_NE(calm.errors.find(lab.host(2)), std::string::npos) << "nothing ran on the second host\n"
                                                                  << calm.errors;
      EXPECT_TRUE(readText(scratch("calm.pfm")) == expected) << "the pictures differ";
    }
    const auto unlucky = render("picture.pfm");
    ASSERT_TRUE(waitFor([&] { return lab.busy(2); }, 30));
    ASSERT_TRUE(unlucky->running()) << unlucky->wait(kPatience).errors;
    ASSERT_EQ(lab.run("crash " + lab.host(2)).status, 0);
    const Finished done = unlucky->wait(kQuickly);
    if (!done.inTime) continue;
    quick = true;
    EXPECT_EQ(done.status, 0) << done.errors;
    EXPECT_NE(done.errors.find("3 tasks died and were replaced"), std::string::npos) << done.errors;
    EXPECT_TRUE(readText(scratch("picture.pfm")) == expected) << "the pictures differ";
  }
  EXPECT_TRUE(quick) << "no crash was got over within " << kQuickly << " s";
}

}  // namespace
}  // namespace rayshade
