// All tasks in one process, in virtual time: what a render would take on another machine.
//
// The tasks are those that run over PVM, with their scheduling, their messages and their picture.  A processor of a simulated host
// takes turns of tasks (event_loop.h), one at a time; a turn takes as long as what it has counted costs (unit_costs.h).  Packets take
// their way through the network (network.h).  Events are handled in the order of their times, and those of one time in the order in which
// they came about: the same run has the same times, to the nanosecond.
//
// The host task runs as ordinary code on top, on a processor of the first host; while it waits, time goes on.  Differences from
// a real machine: the host task's reading of the scene takes no time, nothing dies by itself, and no buffer is ever full.
// docs/decisions/0027-virtual-time.md
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <queue>
#include <set>
#include <unordered_map>

#include "pvm/link/link.h"
#include "pvm/simulation/network.h"
#include "pvm/simulation/unit_costs.h"

namespace rayshade {

class TimedMachine : public Machine {
 public:
  // So many processors: as many hosts as have them, at most those of the machine.
  TimedMachine(const MachineSpec& spec, const UnitCosts& costs, std::uint32_t processors);
  ~TimedMachine() override;

  // What the host task has counted so far.
  void countHost(std::function<Report()> counted) { hostCounted_ = std::move(counted); }

  // The host's side.
  TaskId self() const override { return kHost; }
  TaskId parent() const override { return kNobody; }
  void send(TaskId to, std::span<const std::byte> packet) override;
  std::optional<LinkEvent> poll() override;
  std::optional<LinkEvent> wait(double seconds) override;
  void watch(TaskId task) override { watchers_[task].insert(kHost); }
  double now() const override { return toSeconds(hostNow()); }
  Usage usage() const override;
  unsigned cores() const override { return spec_.cores; }
  void useThreads(unsigned) override {}  // the host has none
  void run(Job) override {}
  std::vector<HostInfo> hosts() override;
  Spawned spawn(Role role, const std::string& host) override;
  void kill(TaskId task) override { bury(task, hostNow()); }

 private:
  static constexpr TaskId kHost{1};
  class Inside;    // the Link of a slave task
  struct Running;  // a slave task

  // What takes a processor of a host for a while: a turn of a task, a job of its threads, or the host task.
  struct Activity {
    TaskId task = kNobody;
    bool job = false;
  };
  struct Host {
    std::string name;
    std::uint32_t freeCores = 0;
    std::deque<Activity> ready;
  };
  struct Packet {
    TaskId to = kNobody;
    LinkEvent event;
    Journey journey;
  };
  struct Happening {
    enum class Kind : std::uint8_t { wake, endOfTurn, jobGiven, endOfJob, onTheWay, arrival } kind;
    Nanoseconds at;
    std::uint64_t order;
    TaskId task;
    std::uint64_t number;  // of the sleep, the worker or the packet
    std::uint32_t host;
  };
  struct Later {
    bool operator()(const Happening& a, const Happening& b) const {
      return a.at != b.at ? a.at > b.at : a.order > b.order;
    }
  };

  void schedule(Happening::Kind kind, Nanoseconds at, TaskId task, std::uint64_t number,
                std::uint32_t host = 0);
  void handle(const Happening& what);
  void advanceTo(Nanoseconds time);
  void sendFrom(TaskId from, TaskId to, LinkEvent event, Nanoseconds at);
  void travel(std::uint64_t number);
  void arrive(std::uint64_t number);
  void wakeUp(Running& running);
  void startReady(std::uint32_t host);
  void startTurn(Running& running);
  void startJob(Running& running);
  void endTurn(TaskId task, std::uint32_t host);
  void endJob(TaskId task, std::uint64_t worker, std::uint32_t host);
  void offerJobs(Running& running);
  void bury(TaskId task, Nanoseconds now);
  std::uint32_t hostOf(TaskId task) const;
  // What counting has cost, on a processor of this machine.
  Nanoseconds cost(const Report& counted) const;
  Nanoseconds hostNow() const;
  void hostGoesOn();  // from now on
  std::optional<LinkEvent> takeForHost();

  MachineSpec spec_;
  UnitCosts costs_;
  Network network_;
  std::vector<Host> hosts_;
  Nanoseconds time_ = 0;
  std::uint64_t order_ = 0;
  std::priority_queue<Happening, std::vector<Happening>, Later> happenings_;
  std::vector<Packet> packets_;
  std::vector<std::uint64_t> freePackets_;
  std::int32_t nextTask_ = 2;
  std::map<TaskId, std::unique_ptr<Running>> tasks_;
  std::map<TaskId, std::set<TaskId>> watchers_;

  std::function<Report()> hostCounted_;
  Nanoseconds hostSince_ = 0, hostCostSince_ = 0, hostBusy_ = 0;
  bool hostActs_ = true;
  std::deque<LinkEvent> forHost_;
};

}  // namespace rayshade
