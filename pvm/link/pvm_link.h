// The link over PVM 3: packets are PVM messages of one tag, deaths are PVM's notices.
//
// routes.h says how two tasks come to a direct route and why send() looks at it first, peers.h when a death is told.  A
// long packet on the way by the daemons can be overtaken by the next on a new route: packets are numbered.
//
// send() blocks while a peer with a direct route does not read (its flow control); one packet is at most 1 GiB.
// LinkLost: the daemon of this machine is gone.  Times in seconds.
// Source: manual pages of PVM 3.4.6 and measurements with it.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>

#include "pvm/link/host_table.h"
#include "pvm/link/link_threads.h"
#include "pvm/link/routes.h"
#include "pvm/link/spawning.h"
#include "pvm/link/task_output.h"
#include "rayshade/base/clock.h"

namespace rayshade {

class PvmLink final : public Machine {
 public:
  // Enrols this process.  Throws LinkLost when there is no virtual machine; see VirtualMachine.
  explicit PvmLink(std::function<Command(Role)> command = usualCommand);
  PvmLink(const PvmLink&) = delete;
  PvmLink& operator=(const PvmLink&) = delete;
  ~PvmLink() override;  // ends the tasks that it spawned and that still run, then leaves the machine

  TaskId self() const override { return self_; }
  TaskId parent() const override { return parent_; }
  void send(TaskId to, std::span<const std::byte> packet) override;
  std::optional<LinkEvent> poll() override { return wait(0); }
  std::optional<LinkEvent> wait(double seconds) override;
  void watch(TaskId task) override;
  double now() const override { return steadySeconds(); }
  Usage usage() const override;  // of the process
  unsigned cores() const override { return coreCount(); }
  void useThreads(unsigned threads) override { threads_.use(threads); }
  void run(Job job) override { threads_.run(std::move(job)); }

  std::vector<HostInfo> hosts() override { return hosts_.answering(self_); }
  Spawned spawn(Role role, const std::string& host) override;  // "": this machine
  void kill(TaskId task) override { daemon_.check(endTask(task), "kill"); }

  bool connected(TaskId peer) const;                  // a direct route stands
  std::uint64_t refused() const { return refused_; }  // messages that were not what they should be

 private:
  void askForExit(TaskId task);
  void buried(TaskId task, const Peer& peer);
  // The next PVM message; 0 or less: the time is over.
  int receive(double seconds);
  int receiveOrWake(double seconds);
  // False: it is not what it should be.
  bool take(int buffer);
  bool takePacket(TaskId from, int bytes);
  bool takeNotice(Tag tag);
  bool takeOutput();

  std::function<Command(Role)> command_;
  Daemon daemon_;
  TaskId self_, parent_;
  HostTable hosts_{daemon_};
  Peers peers_;
  Routes routes_;
  TaskOutput output_;  // of spawned tasks
  LinkThreads threads_;
  std::deque<LinkEvent> events_;  // not yet told
  std::uint64_t refused_ = 0;
};

}  // namespace rayshade
