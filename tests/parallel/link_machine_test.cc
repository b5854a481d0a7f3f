// VirtualMachine with a real PVM daemon, in a private virtual machine.
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/virtual_machine.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>

#include <chrono>
#include <cstring>
#include <fstream>
#include <sstream>
#include <thread>

#include "pvm/link/pvm_link.h"
#include "tests/support/private_machine.h"

namespace rayshade {
namespace {

class MachineOfPvm : public testing::Test {
 protected:
  void SetUp() override {
    if (!PrivateMachine::possible()) GTEST_SKIP() << PrivateMachine::kImpossible;
  }
  PrivateMachine machine;
};

TEST_F(MachineOfPvm, HaltLeavesNoFileAndNoDaemon) {
  machine.start();
  EXPECT_EQ(lookForMachine(), MachineState::alive);
  machine.halt();
  EXPECT_EQ(lookForMachine(), MachineState::none);
  EXPECT_TRUE(machine.nothingLeft());
}

TEST_F(MachineOfPvm, WorkersThatDoNotListenEndToo) {
  machine.start();
  Command command{"/bin/sh", "-c", "echo $$ > " + machine.directory() + "/worker; exec sleep 60"};
  {
    PvmLink link([&](Role) { return command; });
    ASSERT_NE(link.spawn(Role::shade, "").task, kNobody);
    link.wait(0.2);
  }
  pid_t pid = 0;
  std::ifstream(machine.directory() + "/worker") >> pid;
  ASSERT_GT(pid, 0);
  machine.halt();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  std::string state;
  std::ifstream(std::string("/proc/") + std::to_string(pid) + "/stat") >> state >> state >> state;
  EXPECT_TRUE(state.empty() || state == "Z") << state;  // nobody may have collected it yet
}

TEST_F(MachineOfPvm, AMachineThatIsThereIsUsedAndLeftAlone) {
  EXPECT_TRUE(machine.start().startedHere());
  {
    const VirtualMachine second{MachineOptions{}};
    EXPECT_FALSE(second.startedHere());
  }
  EXPECT_EQ(lookForMachine(), MachineState::alive);
}

// A socket at which somebody listens, or has listened until he ended.
int listenAt(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  EXPECT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(listen(listener, 5), 0);
  return listener;
}

TEST_F(MachineOfPvm, AStaleAddressFileIsSurvivedQuickly) {
  const std::string socketName = machine.directory() + "/pvmtmp1.0";
  close(listenAt(socketName));
  std::ofstream(machine.addressFile()) << socketName << "\n";
  EXPECT_EQ(lookForMachine(), MachineState::stale);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(machine.start().startedHere());
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  machine.halt();
  EXPECT_TRUE(machine.nothingLeft());
}

// The daemon of an added host goes into the background: its socket has the number of a process that has ended.
TEST_F(MachineOfPvm, ASocketOfTheEndedGoesOnlyWhenNobodyListens) {
  const pid_t ended = fork();
  if (ended == 0) _exit(0);
  waitpid(ended, nullptr, 0);
  const std::string prefix = machine.directory() + "/pvmtmp" + std::to_string(ended);
  const int daemon = listenAt(prefix + ".0");
  close(listenAt(prefix + ".1"));
  removeRouteSockets();
  EXPECT_TRUE(std::filesystem::exists(prefix + ".0"));
  EXPECT_FALSE(std::filesystem::exists(prefix + ".1"));
  close(daemon);
}

TEST_F(MachineOfPvm, AnEmptyPvmsockMeansNone) {
  setenv("PVMSOCK", "", 1);
  EXPECT_TRUE(machine.start().startedHere());
  EXPECT_EQ(lookForMachine(), MachineState::alive);
  EXPECT_EQ(std::getenv("PVMSOCK"), nullptr);
}

TEST_F(MachineOfPvm, AStaleAddressFileCannotMakeUsRemoveAnotherFile) {
  const std::string precious = machine.directory() + "/precious";
  std::ofstream(precious) << "1";
  std::ofstream(machine.addressFile()) << precious << "\n";
  machine.start();
  EXPECT_TRUE(std::filesystem::exists(precious));
}

TEST_F(MachineOfPvm, AHostThatDoesNotJoinIsNamedUnlessItMay) {
  const std::string file = machine.directory() + "/hosts";
  std::ofstream(file) << "# ours\nlocalhost\nnosuchhost ep=/x\n";
  try {
    machine.start({file, false});
    FAIL() << "nosuchhost has joined";
  } catch (const MachineError& error) {
    EXPECT_NE(std::string(error.what()).find("nosuchhost"), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
  EXPECT_EQ(lookForMachine(), MachineState::none);
  EXPECT_EQ(machine.start({file, true}).missingHosts(), std::vector<std::string>{"nosuchhost"});
}

TEST_F(MachineOfPvm, ThisMachineIsInARunningOneUnderAnyOfItsNames) {
  const std::string running = machine.directory() + "/running", wanted = machine.directory() + "/wanted";
  std::ofstream(running) << "127.0.0.1\n";
  std::ofstream(wanted) << "localhost\n";
  EXPECT_TRUE(machine.start({running, false}).startedHere());
  VirtualMachine second({wanted, false});
  EXPECT_FALSE(second.startedHere());
  EXPECT_TRUE(second.missingHosts().empty());
}

TEST_F(MachineOfPvm, AHostFileThatIsNotThereIsAnError) {
  EXPECT_THROW(machine.start({"/no/such/file", false}), MachineError);
}

TEST(HostFile, DefaultsStandBeforeTheOptionsOfAHost) {
  std::istringstream in("# comment\nalpha sp=2\n* ep=/build wd=/tmp\n\nbeta sp=3\n& gamma\n  delta\n");
  const auto hosts = readHostFile(in, "hosts");
  ASSERT_EQ(hosts.size(), 3u);
  EXPECT_EQ(hosts[0].name + "|" + hosts[0].options, "alpha|sp=2");
  EXPECT_EQ(hosts[1].name + "|" + hosts[1].options, "beta|ep=/build wd=/tmp sp=3");
  EXPECT_EQ(hosts[2].name + "|" + hosts[2].options, "delta|ep=/build wd=/tmp");
}

std::vector<HostLine> hostsOf(const std::string& text) {
  std::istringstream in(text);
  return readHostFile(in, "hosts");
}
std::string problemOf(const std::string& text) {
  try {
    hostsOf(text);
  } catch (const MachineError& error) {
    return error.what();
  }
  return "";
}

TEST(HostFile, SpeedsThatPvmWouldNotTakeAreNamedWithTheirLine) {
  EXPECT_EQ(problemOf("alpha sp=1\nbeta sp=1000000\n"), "");
  for (const char* speed : {"0", "-3", "fast", "1000001", "", "10x", "99999999999999999999"})
    EXPECT_EQ(problemOf("alpha\nbeta ep=/x sp=" + std::string(speed) + "\n"),
              "hosts:2: sp=" + std::string(speed) + ": a whole number from 1 to 1000000 is expected");
  EXPECT_TRUE(problemOf("* sp=0\nalpha sp=7\n").starts_with("hosts:1: sp=0"));
  EXPECT_EQ(hostsOf("* sp=500\nalpha\nbeta sp=7 sp=8\n")[0].speed, 500);
  EXPECT_EQ(hostsOf("* sp=500\nalpha\nbeta sp=7 sp=8\n")[1].speed, 8);
}

TEST(HostFile, ACommentLineOfOursTellsMemory) {
  const auto hosts = hostsOf("# rayshade memory=64 beta\n# rayshade memory=8\nalpha\nbeta\ngamma\n");
  EXPECT_EQ(hosts[0].memory, 8'000'000u);
  EXPECT_EQ(hosts[1].memory, 64'000'000u);
  EXPECT_EQ(hosts[2].memory, 8'000'000u);
  EXPECT_EQ(hostsOf("# memory=64\n#rayshade\n# rayshade is fine\nalpha\n")[0].memory, 0u);
  EXPECT_EQ(problemOf("alpha\n# rayshade memory=64 beta\n"),
            "hosts:2: no line of the file has the host beta");
  EXPECT_EQ(problemOf("alpha\n# rayshade memory=much\n"),
            "hosts:2: memory=much: a whole number from 1 to 1000000000 is expected");
}

}  // namespace
}  // namespace rayshade
