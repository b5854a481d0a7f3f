// Direct routes: sockets between two tasks, past the daemons.
//
// A route costs both tasks a descriptor, some work when it is opened, and a place in each of libpvm's select()s; so it is
// opened when it is known to pay: when a task has sent a few packets to a peer by way of the daemons.  Between two machines it
// is opened at the first packet, and to a task that is watched at once: only a route tells soon that a machine is gone.  A
// task that has no descriptor left for another route goes on with the daemons.
//
// Opening one blocks inside libpvm until the peer enters libpvm too - minutes, if the peer's machine is gone.  So it is
// agreed upon by way of the daemons: the task with the larger id says "come in", by itself or because the other has knocked,
// and then the one with the smaller id opens the route.
//
// When a route ends while pvm_send is in it, libpvm gives the packet to the daemon; and a daemon that has a packet for a
// machine that is gone holds back what it has for all others, up to 13 s at a time, for three minutes.  So whoever sends
// looks at the route first, and to a peer with a sign of death nothing is sent.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/link/daemon.h"
#include "pvm/link/peers.h"

namespace rayshade {

class Routes {
 public:
  // Packets to a peer on the same machine that go by way of the daemon before a route is asked for.
  static constexpr std::uint32_t kPacketsByDaemon = 4;

  Routes(Daemon& daemon, Peers& peers, TaskId self);

  // The end of the peer's machine is to be told soon.
  void watch(TaskId task);
  // Another packet is to be sent: waits until the peer can take it.  False: it leaves, nothing is to be sent.
  bool waitForRoom(TaskId task, const Peer& peer);
  // The messages by which routes are agreed upon, and libpvm's notice of one.  False: it is none of those.
  bool takeHello(TaskId from, Tag tag);
  bool takeNotice();

 private:
  void ask(TaskId peer);
  void letIn(TaskId peer);
  void open(TaskId peer);
  bool farAway(TaskId peer) const { return daemonOf(peer) != daemonOf(self_); }
  bool anyLeft() const { return standing_ < most_; }
  void takeNotices();

  Daemon& daemon_;
  Peers& peers_;
  TaskId self_;
  int most_;  // routes, for which there are descriptors
  int standing_ = 0;
};

}  // namespace rayshade
