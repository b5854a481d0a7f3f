// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/routes.h"

#include <pvm3.h>
#include <sys/resource.h>
#include <sys/select.h>
#include <sys/socket.h>

#include <algorithm>
#include <utility>

namespace rayshade {
namespace {

constexpr int kOtherDescriptors = 24;  // files, the daemon, routes that are just being opened

int mostRoutes() {
  rlimit limit{};
  rlim_t descriptors = FD_SETSIZE;  // libpvm uses select()
  if (getrlimit(RLIMIT_NOFILE, &limit) == 0) descriptors = std::min(descriptors, limit.rlim_cur);
  return std::max(0, static_cast<int>(descriptors) - kOtherDescriptors);
}

// libpvm tells of a route that it will accept already when it begins to listen, and again when it stands.
bool onlyListens(int descriptor) {
  int listens = 0;
  socklen_t size = sizeof listens;
  return getsockopt(descriptor, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) == 0 && listens != 0;
}

}  // namespace

Routes::Routes(Daemon& daemon, Peers& peers, TaskId self)
    : daemon_(daemon), peers_(peers), self_(self), most_(mostRoutes()) {
  pvm_setopt(PvmRoute, PvmAllowDirect);  // use direct routes that stand, ask for none
  daemon_.hardenSockets();
  daemon_.check(pvm_notify(PvmRouteAdd, number(Tag::route), -1, nullptr), "notify");
}

bool Routes::waitForRoom(TaskId task, const Peer& peer) {
  for (;;) {
    if (peer.leaves()) return false;
    if (!peer.direct()) {
      if (peer.sent == (farAway(task) ? 0 : kPacketsByDaemon)) ask(task);
      return true;
    }
    pollfd route{peer.route, POLLOUT | POLLRDHUP, 0};
    ::poll(&route, 1, 0);
    if (route.revents == POLLOUT) return true;
    if (route.revents != 0) {  // it ends, or libpvm has closed it
      peers_.showsSignOfDeath(task);
      return false;
    }
    std::vector<pollfd> sockets{route};
    daemon_.addSockets(sockets);
    ::poll(sockets.data(), sockets.size(), -1);
    // pvm_nrecv takes in what has come, so two tasks that send to each other do not wait for ever.
    takeNotices();
  }
}

void Routes::watch(TaskId task) {
  if (farAway(task)) ask(task);
}

void Routes::ask(TaskId peer) {
  if (!anyLeft()) return;
  if (self_ < peer) {
    daemon_.sendEmpty(peer, Tag::knock);
  } else {
    letIn(peer);
  }
}

void Routes::letIn(TaskId peer) {
  peers_[peer].routeAgreed = true;
  daemon_.sendEmpty(peer, Tag::comeIn);
}

bool Routes::takeHello(TaskId from, Tag tag) {
  if (number(from) <= 0 || from == self_) return false;
  if (tag == Tag::knock && from < self_) {
    if (anyLeft()) letIn(from);
  } else if (tag == Tag::comeIn && self_ < from) {
    if (anyLeft()) open(from);
  }
  return true;
}

void Routes::open(TaskId task) {
  Peer& peer = peers_[task];
  if (peer.leaves() || peer.direct() || std::exchange(peer.routeAgreed, true)) return;
  pvm_setopt(PvmRoute, PvmRouteDirect);
  daemon_.check(pvm_initsend(PvmDataRaw), "initsend");
  const int result = pvm_send(number(task), number(Tag::hello));
  pvm_setopt(PvmRoute, PvmAllowDirect);
  daemon_.check(result, "send");
}

bool Routes::takeNotice() {
  int task = 0, descriptor = -1;  // none: the route is gone
  if (pvm_upkint(&task, 1, 1) < 0) return false;
  pvm_upkint(&descriptor, 1, 1);
  if (descriptor >= 0 && onlyListens(descriptor)) return true;
  Peer& peer = peers_[TaskId{task}];
  standing_ += (descriptor >= 0 ? 1 : 0) - (peer.direct() ? 1 : 0);
  peer.route = descriptor;
  peer.routeAgreed = false;
  if (descriptor >= 0) {
    hardenSocket(descriptor);
    daemon_.notify(PvmRouteDelete, Tag::route, task);
  } else {
    peers_.showsSignOfDeath(TaskId{task});
  }
  return true;
}

void Routes::takeNotices() {
  while (daemon_.check(pvm_nrecv(number(self_), number(Tag::route)), "nrecv") > 0) takeNotice();
}

}  // namespace rayshade
