// The PVM daemon of this machine, as the files of this folder talk to it by way of libpvm.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <poll.h>

#include <stdexcept>

#include "pvm/link/link.h"

namespace rayshade {

// The daemon of this machine is gone, and with it all that this task could do.
class LinkLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Tags.  Whoever is enrolled can send any of them, so notices count only when they come from a daemon or from libpvm.
enum class Tag : int {
  packet = 1,
  knock = 2,
  comeIn = 3,
  hello = 4,
  taskExit = 11,
  route = 12,
  hostGone = 13,
  hostJoined = 14,
  output = 15
};

constexpr int number(Tag tag) { return static_cast<int>(tag); }
constexpr int number(TaskId task) { return static_cast<int>(task); }
int daemonOf(TaskId task);                               // of the machine on which the task runs
inline bool isDaemon(int sender) { return sender < 0; }  // a daemon's id has the top bit set

class Daemon {
 public:
  // What libpvm has answered; `what` was called.  Throws LinkLost when the daemon is gone.
  int check(int code, const char* what);
  bool lost() const { return lost_; }

  // A message without content.
  void sendEmpty(TaskId to, Tag tag);
  // Asks to be told of an event that concerns `id`, by messages with this tag.  `event`: one of PVM's.
  void notify(int event, Tag tag, int id);
  // Adds libpvm's sockets to those that are waited for: each time anew, for routes come and go.
  void hardenSockets();  // all that libpvm has
  void addSockets(std::vector<pollfd>& sockets);

 private:
  bool lost_ = false;
};

// libpvm leaves its sockets open in children, and lets a lost machine block a send for a quarter of an hour.
void hardenSocket(int socket);

}  // namespace rayshade
