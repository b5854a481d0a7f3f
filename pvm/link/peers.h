// The tasks at the other ends of a link: what was exchanged with them, and when their deaths are told.
//
// PVM tells of a task's exit in milliseconds, of a vanished machine after three minutes; the end of a direct route is
// told at once, or after 10 s when a cable is out.  Each of the two can overtake packets that travel on the other way.  So
// a death is told when both have come, or one a while ago.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <unordered_map>

#include "pvm/link/link.h"

namespace rayshade {

// Puts the packets of one sender into the order in which they were sent.
class PacketOrder {
 public:
  // Neither taken nor here already; else it is forged.
  bool expects(std::uint32_t place) const {
    return place - taken_ < kNumbersAhead && !early_.contains(place);
  }
  // Requires expects(place); hands on, in order, all whose turn has come.
  template <class Deliver>
  void take(std::uint32_t place, Bytes&& packet, const Deliver& deliver) {
    if (place != taken_) {
      early_.emplace(place, std::move(packet));
      return;
    }
    deliver(std::move(packet));
    ++taken_;
    while (!early_.empty()) {
      const auto next = early_.extract(taken_);
      if (next.empty()) break;
      deliver(std::move(next.mapped()));
      ++taken_;
    }
  }
  bool gapless() const { return early_.empty(); }
  void forget() { early_.clear(); }

 private:
  static constexpr std::uint32_t kNumbersAhead = 1u
                                                 << 31;  // numbers wrap around: half of them are the future

  std::uint32_t taken_ = 0;
  std::map<std::uint32_t, Bytes> early_;  // came before their turn
};

struct Peer {
  bool child = false;        // spawned here
  bool watched = false;      // the owner of this link wants to know of its death
  bool exitWanted = false;   // PVM was asked to tell of its exit
  bool exited = false;       // PVM told of it
  bool routeAgreed = false;  // a direct route may stand, though libpvm has not told of it
  int route = -1;            // the socket of the direct route that stands, which is libpvm's; -1: none
  bool dead = false;         // nothing more is taken from it
  double ending = 0;         // when the first sign of its death came; 0: none
  std::uint32_t sent = 0;    // packets
  PacketOrder packets;       // from it

  bool direct() const { return route >= 0; }
  bool leaves() const { return dead || ending != 0; }  // nothing is sent to it
};

class Peers {
 public:
  using Buried = std::function<void(TaskId, const Peer&)>;
  explicit Peers(Buried buried) : buried_(std::move(buried)) {}

  Peer& operator[](TaskId task) { return peers_[task]; }
  Peer* find(TaskId task);  // null: nothing was exchanged with it
  const Peer* find(TaskId task) const { return const_cast<Peers*>(this)->find(task); }
  const std::unordered_map<TaskId, Peer>& all() const { return peers_; }

  // Buries it when this sign is the last that was missing.
  void showsSignOfDeath(TaskId task);
  bool anyEnding() const { return ending_ > 0; }
  // Buries those whose signs were not completed in time.
  void reapExpired();

 private:
  void bury(TaskId task, Peer& peer);

  std::unordered_map<TaskId, Peer> peers_;  // node-based: a Peer stays where it is
  int ending_ = 0;                          // show a sign of death and are not buried
  Buried buried_;
};

// Between the first sign of a death and its telling.
inline constexpr double kSettleSeconds = 0.5;

}  // namespace rayshade
