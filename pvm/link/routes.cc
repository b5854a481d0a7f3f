// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/routes.h"

#include <pvm3.h>

namespace rayshade {

Routes::Routes(Daemon& daemon, Peers& peers, TaskId self) : daemon_(daemon), peers_(peers), self_(self) {
  pvm_setopt(PvmRoute, PvmAllowDirect);  // use direct routes that stand, ask for none
  hardenSockets();
  daemon_.check(pvm_notify(PvmRouteAdd, number(Tag::route), -1, nullptr), "notify");
}

void Routes::connect(std::span<const TaskId> peers) {
  takeNotices();
  for (const TaskId task : peers) {
    if (!(self_ < task)) continue;
    const Peer* peer = peers_.find(task);
    if (peer == nullptr || (!peer->direct && !peer->leaves())) daemon_.sendEmpty(task, Tag::knock);
  }
}

bool Routes::takeHello(TaskId from, Tag tag) {
  if (number(from) <= 0 || from == self_) return false;
  if (tag == Tag::knock) {
    daemon_.sendEmpty(from, Tag::comeIn);
  } else if (tag == Tag::hello) {
    stands(from);
  } else if (self_ < from) {
    const Peer* peer = peers_.find(from);
    if (peer == nullptr || !peer->direct) open(from);
  }
  return true;
}

void Routes::open(TaskId peer) {
  pvm_setopt(PvmRoute, PvmRouteDirect);
  daemon_.check(pvm_initsend(PvmDataRaw), "initsend");
  const int result = pvm_send(number(peer), number(Tag::hello));
  pvm_setopt(PvmRoute, PvmAllowDirect);
  if (daemon_.check(result, "send") >= 0) stands(peer);
}

void Routes::stands(TaskId task) {
  Peer& peer = peers_[task];
  if (peer.direct || peer.dead) return;
  peer.direct = true;
  hardenSockets();
  daemon_.notify(PvmRouteDelete, Tag::route, number(task));
}

bool Routes::takeNotice() {
  int task = 0, descriptor = -1;  // none: the route is gone
  if (pvm_upkint(&task, 1, 1) < 0) return false;
  pvm_upkint(&descriptor, 1, 1);
  Peer& peer = peers_[TaskId{task}];
  peer.route = descriptor;
  if (descriptor >= 0) return true;
  peer.direct = false;
  peers_.showsSignOfDeath(TaskId{task});
  return true;
}

void Routes::takeNotices() {
  while (daemon_.check(pvm_nrecv(number(self_), number(Tag::route)), "nrecv") > 0) takeNotice();
}

// pvm_nrecv takes in what has come, so two tasks that send to each other do not wait for ever.
bool Routes::waitForRoom(TaskId task) {
  for (;;) {
    takeNotices();
    Peer& peer = peers_[task];
    if (peer.leaves()) return false;
    if (peer.route < 0) return true;
    std::vector<pollfd> sockets{{peer.route, POLLOUT | POLLRDHUP, 0}};
    ::poll(sockets.data(), 1, 0);
    if ((sockets[0].revents & ~POLLOUT) != 0) {
      peers_.showsSignOfDeath(task);
      return false;
    }
    if (sockets[0].revents != 0) return true;
    daemon_.addSockets(sockets);
    ::poll(sockets.data(), sockets.size(), -1);
  }
}

}  // namespace rayshade
