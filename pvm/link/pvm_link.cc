// See pvm_link.h.
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/pvm_link.h"

#include <pvm3.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "pvm/link/daemon_files.h"

namespace rayshade {
namespace {

constexpr int kFragmentBytes = 65536;  // a packet in one write; PVM's own 4080 costs two thirds of the speed
constexpr double kLastOutputSeconds = 0.2;  // for the last lines of tasks that were ended
constexpr double kFarewellSeconds = 1;      // for the tasks of a daemon that has gone: it has ended them, too
constexpr int kLargestPacket = 1 << 30;
constexpr double kLongestSleep = 1000;

TaskId enrol() {
  if (lookForMachine() != MachineState::alive)  // libpvm would wait 12 s for a daemon that died
    throw LinkLost("there is no PVM virtual machine: start one with `pvm`, or let rayshade-host do it");
  pvm_setopt(PvmAutoErr, 0);
  const int self = pvm_mytid();
  if (self < 0) throw LinkLost("the PVM daemon of this machine does not accept this task");
  pvm_setopt(PvmFragSize, kFragmentBytes);
  return TaskId{self};
}

// Not only PvmNoParent: the console spawns with PvmParentNotSet.
TaskId spawnedBy() { return TaskId{std::max(pvm_parent(), 0)}; }

}  // namespace

PvmLink::PvmLink(std::function<Command(Role)> command)
    : command_(std::move(command)),
      self_(enrol()),
      parent_(spawnedBy()),
      peers_([this](TaskId task, const Peer& peer) { buried(task, peer); }),
      routes_(daemon_, peers_, self_) {
  if (parent_ != kNobody) return;

  // The output of spawned tasks comes to this task as messages.  Not by pvm_catchout: then pvm_exit waits for
  // the end of all of them, of those on a vanished machine too.
  pvm_setopt(PvmOutputTid, number(self_));
  pvm_setopt(PvmOutputContext, pvm_getcontext());
  pvm_setopt(PvmOutputCode, number(Tag::output));
  hosts_.learn();
  daemon_.check(pvm_notify(PvmHostAdd, number(Tag::hostJoined), -1, nullptr), "notify");
}

PvmLink::~PvmLink() {
  try {
    bool ended = false;
    for (const auto& [task, peer] : peers_.all()) {
      if (!peer.child || peer.dead || peer.exited) continue;
      endTask(task);
      ended = true;
    }
    const double end = now() + kLastOutputSeconds;
    while (now() < end && (poll() || ended)) wait(ended ? kLastOutputSeconds / 10 : 0);
  } catch (const std::exception&) {  // the daemon is gone: nobody is left to be told
  }
  output_.endAll();
  if (!daemon_.lost()) pvm_exit();
  // libpvm removes its own in order; those of tasks that were killed are the first task's to remove.
  if (daemon_.lost() || parent_ == kNobody)
    removeRouteSockets(daemon_.lost() && parent_ == kNobody ? kFarewellSeconds : 0);
}

bool PvmLink::connected(TaskId task) const {
  const Peer* peer = peers_.find(task);
  return peer != nullptr && peer->direct();
}

void PvmLink::send(TaskId to, std::span<const std::byte> packet) {
  if (packet.size() > static_cast<std::size_t>(kLargestPacket))
    throw std::length_error("packet of more than 1 GiB");
  if (to == self_) {  // the daemon would only bring it back
    events_.push_back({LinkEvent::Kind::packet, self_, {}, Bytes(packet.begin(), packet.end())});
    return;
  }
  Peer& peer = peers_[to];
  if (!routes_.waitForRoom(to, peer)) return;
  std::uint32_t place = peer.sent++;
  daemon_.check(pvm_initsend(PvmDataRaw), "initsend");
  daemon_.check(pvm_pkuint(&place, 1, 1), "pkuint");
  // pvm_pkbyte reads only, though its type does not say so
  char* bytes = const_cast<char*>(reinterpret_cast<const char*>(packet.data()));
  daemon_.check(pvm_pkbyte(bytes, static_cast<int>(packet.size()), 1), "pkbyte");
  daemon_.check(pvm_send(number(to), number(Tag::packet)), "send");
}

std::optional<LinkEvent> PvmLink::wait(double seconds) {
  const double end = now() + seconds;
  double left = std::max(seconds, 0.0);
  for (; events_.empty(); left = std::max(end - now(), 0.0)) {
    const int buffer = receive(peers_.anyEnding() ? std::min(left, kSettleSeconds / 10) : left);
    if (buffer > 0 && !take(buffer)) ++refused_;
    if (buffer > 0) continue;
    if (peers_.anyEnding()) peers_.reapExpired();
    if (threads_.takeDone()) events_.push_back({LinkEvent::Kind::jobDone, self_, {}, {}});
    if (!(left > 0)) break;
  }
  if (events_.empty()) return std::nullopt;
  LinkEvent event = std::move(events_.front());
  events_.pop_front();
  return event;
}

// libpvm looks at its sockets once, or sleeps in the same call: nothing here looks at them before.
int PvmLink::receive(double seconds) {
  if (!(seconds > 0)) return daemon_.check(pvm_nrecv(-1, -1), "nrecv");
  if (threads_.descriptor() >= 0) return receiveOrWake(seconds);
  const double whole = std::floor(std::min(seconds, kLongestSleep));
  const double micros = std::min((seconds - whole) * 1e6, 999999.0);
  timeval left{static_cast<time_t>(whole), static_cast<suseconds_t>(micros)};
  return daemon_.check(pvm_trecv(-1, -1, &left), "trecv");
}

// The same when threads may wake this one, which libpvm would not notice.
int PvmLink::receiveOrWake(double seconds) {
  const int buffer =
      daemon_.check(pvm_nrecv(-1, -1), "nrecv");  // a message may lie in libpvm with all sockets quiet
  if (buffer > 0) return buffer;
  std::vector<pollfd> sockets;
  daemon_.addSockets(sockets);
  sockets.push_back({threads_.descriptor(), POLLIN, 0});
  ::poll(sockets.data(), sockets.size(), static_cast<int>(std::min(std::ceil(seconds * 1000), 1e9)));
  return daemon_.check(pvm_nrecv(-1, -1), "nrecv");
}

Usage PvmLink::usage() const {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {seconds(usage.ru_utime) + seconds(usage.ru_stime),
          static_cast<std::uint64_t>(usage.ru_maxrss) * 1024};
}

void PvmLink::watch(TaskId task) {
  Peer& peer = peers_[task];
  if (std::exchange(peer.watched, true)) return;
  if (peer.dead) {
    events_.push_back({LinkEvent::Kind::taskExit, task, {}, {}});
    return;
  }
  askForExit(task);
  routes_.watch(task);
}

void PvmLink::askForExit(TaskId task) {
  if (!std::exchange(peers_[task].exitWanted, true)) daemon_.notify(PvmTaskExit, Tag::taskExit, number(task));
}

void PvmLink::buried(TaskId task, const Peer& peer) {
  // The route ended and no daemon tells of an exit: the machine itself may be gone.
  if (peer.exitWanted && !peer.exited) hosts_.seemsGone(daemonOf(task));
  if (peer.watched) events_.push_back({LinkEvent::Kind::taskExit, task, {}, {}});
}

Spawned PvmLink::spawn(Role role, const std::string& host) {
  if (hosts_.silent(host)) return {kNobody, "host " + host + " does not answer"};
  Spawned spawned = spawnTask(daemon_, command_(role), host);
  if (spawned.task != kNobody) {
    peers_[spawned.task].child = true;
    askForExit(spawned.task);
  }
  return spawned;
}

// ---- messages

bool PvmLink::take(int buffer) {
  int bytes = 0, tag = 0, sender = 0;
  if (pvm_bufinfo(buffer, &bytes, &tag, &sender) < 0) return false;
  const bool told = isDaemon(sender) || sender == number(self_);  // libpvm itself tells of routes
  switch (Tag{tag}) {
    case Tag::packet:
      return takePacket(TaskId{sender}, bytes);
    case Tag::knock:
    case Tag::comeIn:
    case Tag::hello:
      return routes_.takeHello(TaskId{sender}, Tag{tag});
    case Tag::route:
      return told && routes_.takeNotice();
    case Tag::taskExit:
    case Tag::hostGone:
    case Tag::hostJoined:
      return told && takeNotice(Tag{tag});
    case Tag::output:
      return told && takeOutput();
  }
  return false;
}

bool PvmLink::takePacket(TaskId from, int bytes) {
  Peer& peer = peers_[from];
  std::uint32_t place = 0;
  const int size = bytes - static_cast<int>(sizeof place);
  // After a death was told nothing may follow.
  if (peer.dead || size < 0 || size > kLargestPacket || pvm_upkuint(&place, 1, 1) < 0) return false;
  Bytes packet(static_cast<std::size_t>(size));
  if (pvm_upkbyte(reinterpret_cast<char*>(packet.data()), size, 1) < 0 || !peer.packets.expects(place))
    return false;
  peer.packets.take(place, std::move(packet), [&](Bytes&& turn) {
    events_.push_back({LinkEvent::Kind::packet, from, {}, std::move(turn)});
  });
  return true;
}

bool PvmLink::takeNotice(Tag tag) {
  int id = 0;
  if (pvm_upkint(&id, 1, 1) < 0) return false;
  if (tag == Tag::hostJoined) {
    for (auto& [daemon, name] : hosts_.learn())
      events_.push_back({LinkEvent::Kind::hostJoined, kNobody, name, {}});
  } else if (tag == Tag::hostGone) {
    if (auto name = hosts_.remove(id))
      events_.push_back({LinkEvent::Kind::hostExit, kNobody, std::move(*name), {}});
  } else if (Peer* peer = peers_.find(TaskId{id})) {
    peer->exited = true;
    hosts_.lives(daemonOf(TaskId{id}));  // it told
    peers_.showsSignOfDeath(TaskId{id});
  }
  return true;
}

// int task, int count: so many bytes of its output; 0 tells of its end, less of its begin.
bool PvmLink::takeOutput() {
  int task = 0, count = 0;
  if (pvm_upkint(&task, 1, 1) < 0 || pvm_upkint(&count, 1, 1) < 0) return false;
  if (count < 0) return output_.forget(task), true;
  if (count == 0) return output_.end(task), true;
  std::string text;
  bool whole = true;
  for (char part[1024]; whole && count > 0; count -= static_cast<int>(sizeof part)) {
    const int size = std::min(count, static_cast<int>(sizeof part));
    whole = pvm_upkbyte(part, size, 1) >= 0;
    if (whole) text.append(part, static_cast<std::size_t>(size));
  }
  output_.add(task, text);
  return whole;
}

}  // namespace rayshade
