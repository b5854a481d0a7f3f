// All tasks in one process: the other implementation of Link.
//
// The host task runs as ordinary code on top; whenever it waits, the machine lets the other tasks move: it delivers one
// packet of a pair of tasks chosen by a seeded generator, or lets a task work for a moment, and so on until something
// arrives for the host.  Packets of one pair stay in order, everything else is shuffled.  Tasks can be killed at any
// move: what was sent to them vanishes, what they sent last may be lost, and those who watch are told.  Time is virtual.
// The same seed gives the same run.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>

#include "pvm/link/link.h"
#include "rayshade/base/random.h"

namespace rayshade {

// Packets and notices on their way.
class Channels {
 public:
  struct Channel {
    TaskId from, to;
    friend auto operator<=>(const Channel&, const Channel&) = default;
  };
  using Queue = std::deque<LinkEvent>;

  const std::map<Channel, Queue>& queues() const { return queues_; }  // none is empty
  std::size_t peak() const { return peak_; }                          // events waiting, all together

  // How many wait there now.
  std::size_t add(const Channel& channel, LinkEvent event);
  LinkEvent take(const Channel& channel);
  // A task is gone: nothing reaches it, and of what it sent to another the first `keep(size)` arrive; all, if that is empty.
  void cut(TaskId task, const std::function<std::size_t(std::size_t size)>& keep);

 private:
  std::map<Channel, Queue> queues_;
  std::size_t size_ = 0, peak_ = 0;
};

class SimulatedMachine : public Machine {
 public:
  struct Options {
    std::uint64_t seed = 1;
    std::vector<HostInfo> hosts{{"simulated", 1000}};
    unsigned cores = 1;  // of each of them
    // A task is killed, or stops to move, every so many moves, by chance; 0: never.
    std::uint64_t movesPerDeath = 0;
    std::uint64_t movesPerHang = 0;
    int mostDeaths = 0;
    std::size_t largestQueue = 0;  // packets of one pair; more is an error; 0: any
  };

  explicit SimulatedMachine(const Options& options);
  ~SimulatedMachine() override;

  // The host's side.
  TaskId self() const override { return kHost; }
  TaskId parent() const override { return kNobody; }
  void send(TaskId to, std::span<const std::byte> packet) override { sendFrom(kHost, to, packet); }
  std::optional<LinkEvent> poll() override;
  std::optional<LinkEvent> wait(double seconds) override;
  void watch(TaskId task) override { watchers_[task].insert(kHost); }
  double now() const override { return time_; }
  Usage usage() const override { return {}; }
  unsigned cores() const override { return options_.cores; }
  void useThreads(unsigned) override {}  // the host has none
  void run(Job) override {}
  std::vector<HostInfo> hosts() override { return options_.hosts; }
  Spawned spawn(Role role, const std::string& host) override;
  void kill(TaskId task) override;

  // Called before every packet that is delivered; may kill.  For tests that aim.
  std::function<void(TaskId from, TaskId to, std::span<const std::byte>)> beforeDelivery;

  std::uint64_t moves() const { return moves_; }
  int deaths() const { return deaths_; }
  std::size_t peakQueue() const { return channels_.peak(); }  // packets waiting, all pairs together

 private:
  static constexpr TaskId kHost{1};
  class Inside;  // the Link of a slave task
  struct Running;

  void sendFrom(TaskId from, TaskId to, std::span<const std::byte> packet);
  void enqueue(TaskId from, TaskId to, LinkEvent event);
  std::uint64_t random(std::uint64_t below);
  bool move(std::optional<LinkEvent>& forHost);
  std::optional<LinkEvent> deliver(const Channels::Channel& channel);
  void injectFault();
  void bury(TaskId task, bool losesWords);

  Options options_;
  std::uint64_t state_;
  double time_ = 0;
  std::uint64_t moves_ = 0;
  int deaths_ = 0;
  int idleWaits_ = 0;
  std::int32_t nextTask_ = 2;
  std::map<TaskId, std::unique_ptr<Running>> tasks_;
  Channels channels_;
  std::map<TaskId, std::set<TaskId>> watchers_;
};

}  // namespace rayshade
