// PvmLink and VirtualMachine with a real PVM daemon, in a private virtual machine.
//
// The workers are this same program, spawned with the argument "--worker"; so it has a main of its own.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <deque>
#include <fstream>
#include <sstream>
#include <thread>

#include "pvm/link/pvm_link.h"
#include "pvm/link/virtual_machine.h"
#include "tests/support/private_machine.h"

namespace rayshade {
namespace {

constexpr double kPatience = 10;  // seconds, for a loaded machine

// What a worker can be asked for: the first byte of a packet.
enum class Ask : std::uint8_t { echo, stream, forward, relay, print, leave, die, hang };

struct Order {
  Ask ask = Ask::echo;
  std::uint32_t number = 0;  // stream: how many; forward: to whom
  Bytes load;
};
template <class Archive>
void serialize(Archive& archive, Order& order) {
  archive(order.ask, order.number, order.load);
}

std::uint32_t idOf(TaskId task) { return static_cast<std::uint32_t>(task); }

// Packets of a stream have very different sizes, so that they travel at different speeds.
std::size_t streamedSize(std::uint32_t index) { return index % 50 == 7 ? 300000 : 1 + index % 1000; }

int work() {
  PvmLink link;
  link.watch(link.parent());
  std::deque<LinkEvent> waiting;
  for (;;) {
    std::optional<LinkEvent> event;
    if (waiting.empty()) {
      event = link.wait(kPatience);
    } else {
      event = std::move(waiting.front());
      waiting.pop_front();
    }
    if (!event) return 1;
    if (event->kind == LinkEvent::Kind::taskExit) return 2;
    auto order = decode<Order>(event->bytes);
    if (!order) continue;
    switch (order->ask) {
      case Ask::echo:
        link.send(event->task, event->bytes);
        break;
      case Ask::stream:
        for (std::uint32_t i = 0; i < order->number; ++i) {
          link.send(event->task, encode(Order{Ask::echo, i, Bytes(streamedSize(i))}));
          while (auto later = link.poll()) waiting.push_back(std::move(*later));
        }
        break;
      case Ask::forward: {
        const TaskId to{static_cast<std::int32_t>(order->number)};
        link.connect({&to, 1});
        link.send(to, encode(Order{Ask::relay, 0, order->load}));
        break;
      }
      case Ask::relay:
        link.send(link.parent(), encode(Order{Ask::echo, idOf(event->task), order->load}));
        break;
      case Ask::print:
        std::printf("on stdout\n");
        std::fflush(stdout);
        std::fprintf(stderr, "on stderr, %s", "without an end");
        return 0;
      case Ask::leave:
        return 0;
      case Ask::die:
        raise(SIGKILL);
        break;
      case Ask::hang:
        std::this_thread::sleep_for(std::chrono::seconds(60));
        break;
    }
  }
}

std::string thisProgram() { return std::filesystem::read_symlink("/proc/self/exe").string(); }
Command workerCommand(Role) { return {thisProgram(), "--worker"}; }

std::optional<LinkEvent> next(PvmLink& link, LinkEvent::Kind kind, double patience = kPatience) {
  for (const double end = link.now() + patience; link.now() < end;) {
    auto event = link.wait(end - link.now());
    if (event && event->kind == kind) return event;
  }
  return std::nullopt;
}

bool nothingLeft(const std::string& directory) {
  return !std::filesystem::exists(directory) || std::filesystem::is_empty(directory);
}

class LinkTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!PrivateMachine::possible()) GTEST_SKIP() << PrivateMachine::kImpossible;
    machine.start();
    link.emplace(workerCommand);
  }
  TaskId worker() {
    const Spawned spawned = link->spawn(Role::shade, "");
    EXPECT_NE(spawned.task, kNobody) << spawned.problem;
    return spawned.task;
  }
  // A task answers as soon as it is enrolled.
  bool answers(TaskId task) {
    link->send(task, encode(Order{}));
    return next(*link, LinkEvent::Kind::packet).has_value();
  }
  bool connected(TaskId task) {
    link->connect({&task, 1});
    for (const double end = link->now() + kPatience; link->now() < end && !link->connected(task);)
      link->wait(0.01);
    return link->connected(task);
  }

  PrivateMachine machine;
  std::optional<PvmLink> link;
};

TEST_F(LinkTest, PacketsOfAllSizesComeBackUnchanged) {
  const TaskId task = worker();
  for (const bool direct : {false, true}) {
    if (direct) {
      ASSERT_TRUE(connected(task));
    }
    for (const std::size_t size : {1u, 7u, 4080u, 32768u, 32769u, 65536u, 1000000u, 4194304u}) {
      Order order{Ask::echo, static_cast<std::uint32_t>(size), Bytes(size)};
      for (std::size_t i = 0; i < size; ++i) order.load[i] = static_cast<std::byte>(i * 2654435761u >> 24);
      const Bytes packet = encode(order);
      link->send(task, packet);
      const auto event = next(*link, LinkEvent::Kind::packet);
      ASSERT_TRUE(event) << size;
      EXPECT_EQ(event->task, task);
      EXPECT_TRUE(event->bytes == packet) << size;
    }
  }
  EXPECT_EQ(link->refused(), 0u);
}

TEST_F(LinkTest, OrderIsKeptWhileARouteOpens) {
  const TaskId task = worker();
  constexpr std::uint32_t kCount = 1000;
  link->send(task, encode(Order{Ask::stream, kCount, {}}));
  for (std::uint32_t i = 0; i < kCount; ++i) {
    if (i == 10) link->connect({&task, 1});
    const auto event = next(*link, LinkEvent::Kind::packet);
    ASSERT_TRUE(event) << i;
    const auto order = decode<Order>(event->bytes);
    ASSERT_TRUE(order) << i;
    ASSERT_EQ(order->number, i);
    ASSERT_EQ(order->load.size(), streamedSize(i));
  }
  EXPECT_TRUE(connected(task));
}

TEST_F(LinkTest, WorkersTalkToEachOther) {
  const TaskId first = worker(), second = worker();
  for (const auto& [from, to] : {std::pair(first, second), std::pair(second, first)}) {
    for (int i = 0; i < 20; ++i) {
      const Bytes load(1, static_cast<std::byte>(i));
      link->send(from, encode(Order{Ask::forward, idOf(to), load}));
      const auto event = next(*link, LinkEvent::Kind::packet);
      ASSERT_TRUE(event);
      EXPECT_EQ(event->task, to);
      const auto order = decode<Order>(event->bytes);
      ASSERT_TRUE(order);
      EXPECT_EQ(order->number, idOf(from));
      EXPECT_TRUE(order->load == load);
    }
  }
}

TEST_F(LinkTest, DeathIsToldOnceAndWithinASecond) {
  for (const bool direct : {false, true}) {
    const TaskId task = worker();
    ASSERT_TRUE(answers(task));
    if (direct) {
      ASSERT_TRUE(connected(task));
    }
    link->watch(task);
    link->watch(task);
    link->send(task, encode(Order{Ask::die, 0, {}}));
    const double start = link->now();
    const auto event = next(*link, LinkEvent::Kind::taskExit);
    ASSERT_TRUE(event);
    EXPECT_EQ(event->task, task);
    EXPECT_LT(link->now() - start, 1);
    EXPECT_FALSE(next(*link, LinkEvent::Kind::taskExit, 0.1));
    link->send(task, encode(Order{}));  // vanishes
  }
}

TEST_F(LinkTest, TheLastPacketsOfATaskThatLeavesArriveBeforeItsDeath) {
  const TaskId task = worker();
  ASSERT_TRUE(connected(task));
  link->watch(task);
  constexpr std::uint32_t kCount = 60;
  link->send(task, encode(Order{Ask::stream, kCount, {}}));
  link->send(task, encode(Order{Ask::echo, 1000, {}}));
  link->send(task, encode(Order{Ask::leave, 0, {}}));
  std::uint32_t packets = 0;
  for (;;) {
    const auto event = link->wait(kPatience);
    ASSERT_TRUE(event);
    if (event->kind == LinkEvent::Kind::taskExit) break;
    if (event->kind == LinkEvent::Kind::packet) ++packets;
  }
  EXPECT_GE(packets, kCount);
}

TEST_F(LinkTest, TheDeathOfOneThatIsDeadAlreadyIsTold) {
  const TaskId task = worker();
  ASSERT_TRUE(answers(task));
  link->kill(task);
  link->wait(0.2);
  link->watch(task);
  const auto event = next(*link, LinkEvent::Kind::taskExit);
  ASSERT_TRUE(event);
  EXPECT_EQ(event->task, task);
}

TEST_F(LinkTest, ATaskThatHangsCanBeKilled) {
  const TaskId task = worker();
  ASSERT_TRUE(answers(task));
  link->watch(task);
  link->send(task, encode(Order{Ask::hang, 0, {}}));
  link->wait(0.05);
  const double start = link->now();
  link->kill(task);
  EXPECT_TRUE(next(*link, LinkEvent::Kind::taskExit));
  EXPECT_LT(link->now() - start, 1);
}

TEST_F(LinkTest, ConnectingToTheDeadDoesNotBlock) {
  const TaskId task = worker();
  ASSERT_TRUE(answers(task));
  link->kill(task);
  link->wait(0.1);
  const double start = link->now();
  link->connect({&task, 1});
  const TaskId never{0x7ffff};
  link->connect({&never, 1});
  link->wait(0.1);
  EXPECT_LT(link->now() - start, 1);
}

TEST_F(LinkTest, OutputOfWorkersComesToOurStderrWithoutMarks) {
  const TaskId task = worker();
  link->watch(task);
  testing::internal::CaptureStderr();
  link->send(task, encode(Order{Ask::print, 0, {}}));
  EXPECT_TRUE(next(*link, LinkEvent::Kind::taskExit));
  next(*link, LinkEvent::Kind::packet, 0.2);
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_NE(text.find("on stdout\n"), std::string::npos) << text;
  EXPECT_NE(text.find("on stderr, without an end\n"), std::string::npos) << text;
  EXPECT_EQ(text.find('['), std::string::npos) << text;
}

TEST_F(LinkTest, AMissingProgramIsNamedInTheProblem) {
  link.emplace([](Role role) { return Command{std::string("/no/such/place/") + programName(role)}; });
  const Spawned spawned = link->spawn(Role::pyramidTrace, "");
  EXPECT_EQ(spawned.task, kNobody);
  EXPECT_NE(spawned.problem.find("/no/such/place/rayshade-pyramid-trace"), std::string::npos)
      << spawned.problem;
}

TEST_F(LinkTest, AMissingHostIsNamedInTheProblem) {
  const Spawned spawned = link->spawn(Role::shade, "nosuchhost");
  EXPECT_EQ(spawned.task, kNobody);
  EXPECT_NE(spawned.problem.find("nosuchhost"), std::string::npos) << spawned.problem;
}

TEST_F(LinkTest, NoFileStaysAfterRoutesStood) {
  const TaskId first = worker(), second = worker();
  ASSERT_TRUE(connected(first) && connected(second));
  link.reset();
  machine.halt();
  EXPECT_TRUE(nothingLeft(machine.directory()));
}

TEST_F(LinkTest, TheOwnHostIsListedFirst) {
  const auto hosts = link->hosts();
  ASSERT_EQ(hosts.size(), 1u);
  EXPECT_EQ(hosts[0].name, "localhost");
  EXPECT_EQ(hosts[0].speed, 1000);
}

TEST_F(LinkTest, TheFirstTaskHasNoParent) { EXPECT_EQ(link->parent(), kNobody); }

TEST_F(LinkTest, TheEndOfTheDaemonIsACleanFailure) {
  std::ifstream in(machine.addressFile());
  std::string socket;
  std::getline(in, socket);
  const pid_t daemon = std::stoi(socket.substr(socket.find("pvmtmp") + 6));
  kill(daemon, SIGKILL);
  EXPECT_THROW(
      {
        for (int i = 0; i < 100; ++i) link->wait(0.1);
      },
      LinkLost);
}

TEST_F(LinkTest, TheEndOfALinkEndsItsWorkers) {
  const TaskId task = worker();
  ASSERT_TRUE(answers(task));
  link->send(task, encode(Order{Ask::hang, 0, {}}));
  link.reset();
  link.emplace(workerCommand);
  link->watch(task);
  const double start = link->now();
  EXPECT_TRUE(next(*link, LinkEvent::Kind::taskExit));
  EXPECT_LT(link->now() - start, 1);
}

class MachineTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!PrivateMachine::possible()) GTEST_SKIP() << PrivateMachine::kImpossible;
  }
  PrivateMachine machine;
};

TEST_F(MachineTest, HaltLeavesNoFileAndNoDaemon) {
  machine.start();
  EXPECT_EQ(lookForMachine(), MachineState::alive);
  machine.halt();
  EXPECT_EQ(lookForMachine(), MachineState::none);
  EXPECT_TRUE(nothingLeft(machine.directory()));
}

TEST_F(MachineTest, WorkersThatDoNotListenEndToo) {
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

TEST_F(MachineTest, AMachineThatIsThereIsUsedAndLeftAlone) {
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

TEST_F(MachineTest, AStaleAddressFileIsSurvivedQuickly) {
  const std::string socketName = machine.directory() + "/pvmtmp1.0";
  close(listenAt(socketName));
  std::ofstream(machine.addressFile()) << socketName << "\n";
  EXPECT_EQ(lookForMachine(), MachineState::stale);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(machine.start().startedHere());
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  machine.halt();
  EXPECT_TRUE(nothingLeft(machine.directory()));
}

// The daemon of an added host goes into the background: its socket has the number of a process that has ended.
TEST_F(MachineTest, ASocketOfTheEndedGoesOnlyWhenNobodyListens) {
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

TEST_F(MachineTest, AnEmptyPvmsockMeansNone) {
  setenv("PVMSOCK", "", 1);
  EXPECT_TRUE(machine.start().startedHere());
  EXPECT_EQ(lookForMachine(), MachineState::alive);
  EXPECT_EQ(std::getenv("PVMSOCK"), nullptr);
}

TEST_F(MachineTest, AStaleAddressFileCannotMakeUsRemoveAnotherFile) {
  const std::string precious = machine.directory() + "/precious";
  std::ofstream(precious) << "1";
  std::ofstream(machine.addressFile()) << precious << "\n";
  machine.start();
  EXPECT_TRUE(std::filesystem::exists(precious));
}

TEST_F(MachineTest, AHostThatDoesNotJoinIsNamedUnlessItMay) {
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

TEST_F(MachineTest, ThisMachineIsInARunningOneUnderAnyOfItsNames) {
  const std::string running = machine.directory() + "/running", wanted = machine.directory() + "/wanted";
  std::ofstream(running) << "127.0.0.1\n";
  std::ofstream(wanted) << "localhost\n";
  EXPECT_TRUE(machine.start({running, false}).startedHere());
  VirtualMachine second({wanted, false});
  EXPECT_FALSE(second.startedHere());
  EXPECT_TRUE(second.missingHosts().empty());
}

TEST_F(MachineTest, AHostFileThatIsNotThereIsAnError) {
  EXPECT_THROW(machine.start({"/no/such/file", false}), MachineError);
}

TEST(HostFile, DefaultsStandBeforeTheOptionsOfAHost) {
  std::istringstream in("# comment\nalpha sp=2\n* ep=/build wd=/tmp\n\nbeta sp=3\n& gamma\n  delta\n");
  const auto hosts = readHostFile(in);
  ASSERT_EQ(hosts.size(), 3u);
  EXPECT_EQ(hosts[0].name + "|" + hosts[0].options, "alpha|sp=2");
  EXPECT_EQ(hosts[1].name + "|" + hosts[1].options, "beta|ep=/build wd=/tmp sp=3");
  EXPECT_EQ(hosts[2].name + "|" + hosts[2].options, "delta|ep=/build wd=/tmp");
}

TEST(NoMachine, ALinkWithoutAMachineSaysSoAtOnce) {
  if (!PrivateMachine::possible()) GTEST_SKIP() << PrivateMachine::kImpossible;
  const PrivateMachine machine;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THROW(PvmLink{}, LinkLost);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
}

}  // namespace
}  // namespace rayshade

int main(int count, char** words) {
  if (count > 1 && std::string(words[1]) == "--worker") return rayshade::work();
  testing::InitGoogleTest(&count, words);
  return RUN_ALL_TESTS();
}
