// PvmLink with a real PVM daemon, in a private virtual machine.
//
// The workers are this same program, spawned with the argument "--worker"; so it has a main of its own.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <deque>
#include <fstream>
#include <thread>

#include "pvm/link/pvm_link.h"
#include "tests/support/private_machine.h"

namespace rayshade {
namespace {

constexpr double kPatience = 10;  // seconds, for a loaded machine

// What a worker can be asked for: the first byte of a packet.
enum class Ask : std::uint8_t { echo, note, stream, forward, relay, print, leave, die, hang };

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
      case Ask::note:
        break;
      case Ask::stream:
        for (std::uint32_t i = 0; i < order->number; ++i) {
          link.send(event->task, encode(Order{Ask::echo, i, Bytes(streamedSize(i))}));
          while (auto later = link.poll()) waiting.push_back(std::move(*later));
        }
        break;
      case Ask::forward: {
        const TaskId to{static_cast<std::int32_t>(order->number)};
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

class LinkOverPvm : public testing::Test {
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
    for (const double end = link->now() + kPatience; link->now() < end && !link->connected(task);)
      if (!answers(task)) return false;
    return link->connected(task);
  }

  PrivateMachine machine;
  std::optional<PvmLink> link;
};

TEST_F(LinkOverPvm, PacketsOfAllSizesComeBackUnchanged) {
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

TEST_F(LinkOverPvm, OrderIsKeptWhileARouteOpens) {
  const TaskId task = worker();
  constexpr std::uint32_t kCount = 1000;
  link->send(task, encode(Order{Ask::stream, kCount, {}}));
  for (std::uint32_t i = 0; i < kCount; ++i) {
    if (i < 20) link->send(task, encode(Order{Ask::note, i, {}}));
    const auto event = next(*link, LinkEvent::Kind::packet);
    ASSERT_TRUE(event) << i;
    const auto order = decode<Order>(event->bytes);
    ASSERT_TRUE(order) << i;
    ASSERT_EQ(order->number, i);
    ASSERT_EQ(order->load.size(), streamedSize(i));
  }
  EXPECT_TRUE(link->connected(task));
}

TEST_F(LinkOverPvm, WorkersTalkToEachOther) {
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

TEST_F(LinkOverPvm, DeathIsToldOnceAndWithinASecond) {
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

TEST_F(LinkOverPvm, TheLastPacketsOfATaskThatLeavesArriveBeforeItsDeath) {
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

TEST_F(LinkOverPvm, TheDeathOfOneThatIsDeadAlreadyIsTold) {
  const TaskId task = worker();
  ASSERT_TRUE(answers(task));
  link->kill(task);
  link->wait(0.2);
  link->watch(task);
  const auto event = next(*link, LinkEvent::Kind::taskExit);
  ASSERT_TRUE(event);
  EXPECT_EQ(event->task, task);
}

TEST_F(LinkOverPvm, ATaskThatHangsCanBeKilled) {
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

TEST_F(LinkOverPvm, SendingToTheDeadDoesNotBlock) {
  const TaskId task = worker();
  ASSERT_TRUE(answers(task));
  link->kill(task);
  const double start = link->now();
  for (const TaskId to : {task, TaskId{0x7ffff}}) {
    for (int i = 0; i < 50; ++i) link->send(to, encode(Order{}));
    link->wait(0.01);
  }
  EXPECT_LT(link->now() - start, 1);
}

TEST_F(LinkOverPvm, ARouteIsOpenedWhenAPairHasExchangedAFewPackets) {
  const TaskId task = worker(), other = worker();
  for (std::uint32_t i = 0; i < Routes::kPacketsByDaemon; ++i) {
    ASSERT_TRUE(answers(task));
    EXPECT_FALSE(link->connected(task)) << i;
  }
  EXPECT_TRUE(connected(task));
  ASSERT_TRUE(answers(other));
  EXPECT_FALSE(link->connected(other));
}

// Any number of peers can be talked to, whatever number of files may be open.
TEST_F(LinkOverPvm, WithoutDescriptorsForRoutesPacketsGoByTheDaemons) {
  rlimit before{};
  getrlimit(RLIMIT_NOFILE, &before);
  rlimit few = before;
  few.rlim_cur = 24;
  setrlimit(RLIMIT_NOFILE, &few);
  link.emplace(workerCommand);
  const TaskId task = worker();
  for (std::uint32_t i = 0; i < 5 * Routes::kPacketsByDaemon; ++i) ASSERT_TRUE(answers(task));
  EXPECT_FALSE(link->connected(task));
  setrlimit(RLIMIT_NOFILE, &before);
}

TEST_F(LinkOverPvm, WhatATaskSendsToItselfComesBackInOrder) {
  for (std::uint32_t i = 0; i < 10; ++i) link->send(link->self(), encode(Order{Ask::note, i, {}}));
  for (std::uint32_t i = 0; i < 10; ++i) {
    const auto event = link->poll();
    ASSERT_TRUE(event);
    EXPECT_EQ(event->task, link->self());
    EXPECT_EQ(decode<Order>(event->bytes)->number, i);
  }
  EXPECT_FALSE(link->poll());
}

TEST_F(LinkOverPvm, OutputOfWorkersComesToOurStderrWithoutMarks) {
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

TEST_F(LinkOverPvm, AMissingProgramIsNamedInTheProblem) {
  link.emplace([](Role role) { return Command{std::string("/no/such/place/") + programName(role)}; });
  const Spawned spawned = link->spawn(Role::pyramidTrace, "");
  EXPECT_EQ(spawned.task, kNobody);
  EXPECT_NE(spawned.problem.find("/no/such/place/rayshade-pyramid-trace"), std::string::npos)
      << spawned.problem;
}

TEST_F(LinkOverPvm, AMissingHostIsNamedInTheProblem) {
  const Spawned spawned = link->spawn(Role::shade, "nosuchhost");
  EXPECT_EQ(spawned.task, kNobody);
  EXPECT_NE(spawned.problem.find("nosuchhost"), std::string::npos) << spawned.problem;
}

TEST_F(LinkOverPvm, NoFileStaysAfterRoutesStood) {
  const TaskId first = worker(), second = worker();
  ASSERT_TRUE(connected(first) && connected(second));
  link.reset();
  machine.halt();
  EXPECT_TRUE(machine.nothingLeft());
}

TEST_F(LinkOverPvm, TheOwnHostIsListedFirst) {
  const auto hosts = link->hosts();
  ASSERT_EQ(hosts.size(), 1u);
  EXPECT_EQ(hosts[0].name, "localhost");
  EXPECT_EQ(hosts[0].speed, 1000);
}

TEST_F(LinkOverPvm, TheFirstTaskHasNoParent) { EXPECT_EQ(link->parent(), kNobody); }

TEST_F(LinkOverPvm, TheEndOfTheDaemonIsACleanFailure) {
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

TEST_F(LinkOverPvm, TheEndOfALinkEndsItsWorkers) {
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
