// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/peers.h"

#include <set>

#include "pvm/link/daemon.h"
#include "rayshade/base/clock.h"

namespace rayshade {

Peer* Peers::find(TaskId task) {
  const auto found = peers_.find(task);
  return found == peers_.end() ? nullptr : &found->second;
}

void Peers::showsSignOfDeath(TaskId task) {
  Peer& peer = peers_[task];
  if (peer.dead) return;
  if (peer.ending == 0) {
    peer.ending = steadySeconds();
    ++ending_;
  }
  if (peer.exited && !peer.direct() && !peer.routeAgreed && peer.packets.gapless()) bury(task, peer);
}

void Peers::reapExpired() {
  const double now = steadySeconds();
  std::set<int> machines;
  for (const auto& [task, peer] : peers_) {
    if (!peer.dead && peer.ending != 0 && now - peer.ending > kSettleSeconds) machines.insert(daemonOf(task));
  }
  // Who leaves the same machine a moment later is told with it: one recovery instead of several.
  for (auto& [task, peer] : peers_) {
    if (!peer.dead && peer.ending != 0 && machines.contains(daemonOf(task))) bury(task, peer);
  }
}

void Peers::bury(TaskId task, Peer& peer) {
  peer.dead = true;
  peer.packets.forget();
  --ending_;
  buried_(task, peer);
}

}  // namespace rayshade
