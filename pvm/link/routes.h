// Direct routes: sockets between two tasks, past the daemons.
//
// Packets travel by way of the daemons until a direct route to the peer stands.  Opening one blocks inside libpvm until the
// peer enters libpvm too - minutes, if the peer's machine is gone - so connect() only knocks, by way of the daemons, and
// the route is opened when the answer has come.  Of two tasks the one with the smaller id knocks.
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
  Routes(Daemon& daemon, Peers& peers, TaskId self);

  void connect(std::span<const TaskId> peers);
  // Waits until the peer can take a packet.  False: it leaves, nothing is to be sent.
  bool waitForRoom(TaskId peer);
  // The messages by which routes are agreed upon, and libpvm's notice of one.  False: it is none of those.
  bool takeHello(TaskId from, Tag tag);
  bool takeNotice();

 private:
  void open(TaskId peer);
  void stands(TaskId peer);
  void takeNotices();

  Daemon& daemon_;
  Peers& peers_;
  TaskId self_;
};

}  // namespace rayshade
