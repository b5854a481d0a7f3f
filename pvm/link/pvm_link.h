// The link over PVM 3: packets are PVM messages of one tag, deaths are PVM's notices.
//
// Routes.  Packets travel by way of the daemons until a direct route to the peer stands.  Opening one blocks inside
// libpvm until the peer enters libpvm too - minutes, if the peer's machine is gone - so connect() only knocks, by
// way of the daemons, and the route is opened when the answer has come.  Of two tasks the one with the smaller
// id knocks.  A long packet on the old way can be overtaken by the next on the new one: packets are numbered.
//
// Deaths.  PVM tells of a task's exit in milliseconds, of a vanished machine after three minutes; the end of a direct
// route is told at once, or after 10 s when a cable is out.  A death is told when both have come, or one a while ago.
//
// When a route ends while pvm_send is in it, libpvm gives the packet to the daemon; and a daemon that has a packet for a
// machine that is gone holds back what it has for all others, up to 13 s at a time, for three minutes.  So send()
// looks at the route first, and to a peer with a sign of death nothing is sent.
//
// send() blocks while a peer with a direct route does not read (its flow control); one packet is at most 1 GiB.
// LinkLost: the daemon of this machine is gone, and with it all that this task could do.  Times in seconds.
// Source: manual pages of PVM 3.4.6 and measurements with it.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <stdexcept>

#include "pvm/link/link.h"

namespace rayshade {

class LinkLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The program of a role and its arguments.
using Command = std::vector<std::string>;

// RAYSHADE_TASKS/name, else name beside the program that runs now.
Command usualCommand(Role role);

class PvmLink final : public Machine {
 public:
  // Enrols this process.  Throws LinkLost when there is no virtual machine; see VirtualMachine.
  explicit PvmLink(std::function<Command(Role)> command = usualCommand);
  PvmLink(const PvmLink&) = delete;
  PvmLink& operator=(const PvmLink&) = delete;
  ~PvmLink() override;  // ends the tasks that it spawned and that still run, then leaves the machine

  TaskId self() const override { return self_; }
  TaskId parent() const override { return parent_; }
  void connect(std::span<const TaskId> peers) override;
  void send(TaskId to, std::span<const std::byte> packet) override;
  std::optional<LinkEvent> poll() override;
  std::optional<LinkEvent> wait(double seconds) override;
  void watch(TaskId task) override;
  double now() const override;

  std::vector<HostInfo> hosts() override;                      // without those that do not answer
  Spawned spawn(Role role, const std::string& host) override;  // "": this machine
  void kill(TaskId task) override;

  bool connected(TaskId peer) const;                  // a direct route stands
  std::uint64_t refused() const { return refused_; }  // messages that were not what they should be

 private:
  struct Peer {
    bool asked = false;                    // PVM was asked to tell of its exit
    bool watched = false;                  // the owner of this link wants to know of it
    bool child = false;                    // spawned here
    bool direct = false;                   // a direct route stands
    int route = -1;                        // its socket, which is libpvm's; -1: none
    bool exited = false;                   // PVM told of its exit
    bool dead = false;                     // nothing more is taken from it
    double ending = 0;                     // when the first sign of its death came; 0: none
    std::uint32_t sent = 0, taken = 0;     // packets to it and from it
    std::map<std::uint32_t, Bytes> early;  // packets that came before their turn
  };

  void take(int buffer);  // one PVM message
  void takePacket(TaskId from, int bytes);
  void takeHello(TaskId from, int tag);
  void takeNotice(int tag);
  void takeOutput();
  void takeRouteNotices();
  bool leaves(TaskId peer) const;  // dead, or with a sign of it: nothing is sent to it
  bool waitForRoom(TaskId task);
  void askForExit(TaskId task);
  void sendEmpty(TaskId to, int tag);
  void openRoute(TaskId peer);
  void routeStands(TaskId peer);
  void reapExpiredPeers();
  void showsSignOfDeath(TaskId task);
  void bury(TaskId task);
  void learnHosts();
  int check(int code, const char* what);

  std::function<Command(Role)> command_;
  TaskId self_ = kNobody, parent_ = kNobody;
  std::map<TaskId, Peer> peers_;
  std::set<int> silentHosts_;         // daemons of machines that seem to be gone: nothing is asked of them
  std::map<int, std::string> hosts_;  // by the id of the daemon
  std::map<int, std::string> unfinishedLine_;  // of the output of spawned tasks
  std::deque<LinkEvent> events_;               // not yet told
  int ending_ = 0;                             // peers that show a sign of death and are not buried
  bool lost_ = false;                          // the daemon is gone
  std::uint64_t refused_ = 0;
};

}  // namespace rayshade
