// See pvm_link.h.
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/pvm_link.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <pvm3.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "pvm/link/virtual_machine.h"

namespace rayshade {
namespace {

constexpr int kFragmentBytes = 65536;  // a packet in one write; PVM's own 4080 costs two thirds of the speed
constexpr int kSocketBytes = 512 * 1024;    // as far as the system allows
constexpr int kSilenceSeconds = 10;         // a machine that acknowledges nothing for so long is dead
constexpr double kSettleSeconds = 0.5;      // between the first sign of a death and its telling
constexpr double kLastOutputSeconds = 0.2;  // for the last lines of tasks that were ended
constexpr int kLargestPacket = 1 << 30;
constexpr std::uint32_t kNumbersAhead = 1u << 31;  // numbers wrap around: half of them are the future
constexpr std::size_t kLongestLine = 4096;         // of a task's output; a longer one is cut in two

// Tags.  Whoever is enrolled can send any of them, so notices count only when they come from a daemon or from libpvm.
constexpr int kPacket = 1, kKnock = 2, kComeIn = 3, kHello = 4;
constexpr int kTaskExit = 11, kRoute = 12, kHostGone = 13, kHostJoined = 14, kOutput = 15;

int number(TaskId task) { return static_cast<int>(task); }

// A daemon's id has the top bit set.
bool fromDaemon(int sender) { return sender < 0; }

// libpvm leaves its sockets open in children, and lets a lost machine block a send for a quarter of an hour.
void hardenSockets() {
  int* descriptors = nullptr;
  const int count = pvm_getfds(&descriptors);
  for (int i = 0; i < count; ++i) {
    const int socket = descriptors[i];
    const auto set = [socket](int level, int option, int value) {
      setsockopt(socket, level, option, &value, sizeof value);  // what is refused is not needed
    };
    fcntl(socket, F_SETFD, FD_CLOEXEC);
    set(SOL_SOCKET, SO_SNDBUF, kSocketBytes);
    set(SOL_SOCKET, SO_RCVBUF, kSocketBytes);
    int domain = 0;
    socklen_t size = sizeof domain;
    if (getsockopt(socket, SOL_SOCKET, SO_DOMAIN, &domain, &size) != 0 || domain != AF_INET) continue;
    set(SOL_SOCKET, SO_KEEPALIVE, 1);
    set(IPPROTO_TCP, TCP_KEEPIDLE, kSilenceSeconds / 2);
    set(IPPROTO_TCP, TCP_KEEPINTVL, 1);
    set(IPPROTO_TCP, TCP_KEEPCNT, kSilenceSeconds / 2);
    set(IPPROTO_TCP, TCP_USER_TIMEOUT, kSilenceSeconds * 1000);
  }
}

std::string whyNotStarted(int code) {
  switch (code) {
    case PvmNoHost:
      return "no such host in the virtual machine";
    case PvmOutOfRes:
      return "the host has no room for another task";
    case PvmNoMem:
      return "the host has not enough memory";
    case PvmHostFail:
      return "the host failed";
    case PvmDSysErr:
      return "the daemon there could not start it";
    default:
      return "PVM says error " + std::to_string(code);
  }
}

// A task that hangs may have been stopped, and then a signal that can be waited with does not end it.
int endProcess(int task) {
  pvm_kill(task);
  return pvm_sendsig(task, SIGKILL);
}

}  // namespace

Command usualCommand(Role role) {
  const char* given = std::getenv("RAYSHADE_TASKS");
  std::error_code ignored;
  const std::filesystem::path directory =
      given && *given ? std::filesystem::path(given)
                      : std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  return {(directory / programName(role)).string()};
}

PvmLink::PvmLink(std::function<Command(Role)> command) : command_(std::move(command)) {
  if (lookForMachine() != MachineState::alive)  // libpvm would wait 12 s for a daemon that died
    throw LinkLost("there is no PVM virtual machine: start one with `pvm`, or let rayshade-host do it");
  pvm_setopt(PvmAutoErr, 0);
  const int self = pvm_mytid();
  if (self < 0) throw LinkLost("the PVM daemon of this machine does not accept this task");
  self_ = TaskId{self};
  // Not only PvmNoParent: the console spawns with PvmParentNotSet.
  if (const int parent = pvm_parent(); parent > 0) parent_ = TaskId{parent};

  pvm_setopt(PvmFragSize, kFragmentBytes);
  pvm_setopt(PvmRoute, PvmAllowDirect);  // use direct routes that stand, ask for none
  hardenSockets();
  check(pvm_notify(PvmRouteAdd, kRoute, -1, nullptr), "notify");
  if (parent_ != kNobody) return;

  // The output of spawned tasks comes to this task as messages.  Not by pvm_catchout: then pvm_exit waits for
  // the end of all of them, of those on a vanished machine too.
  pvm_setopt(PvmOutputTid, self);
  pvm_setopt(PvmOutputContext, pvm_getcontext());
  pvm_setopt(PvmOutputCode, kOutput);
  learnHosts();
  check(pvm_notify(PvmHostAdd, kHostJoined, -1, nullptr), "notify");
}

PvmLink::~PvmLink() {
  try {
    bool ended = false;
    for (const auto& [task, peer] : peers_) {
      if (!peer.child || peer.dead || peer.exited) continue;
      endProcess(number(task));
      ended = true;
    }
    const double end = now() + kLastOutputSeconds;
    while (now() < end && (poll() || ended)) wait(ended ? kLastOutputSeconds / 10 : 0);
  } catch (const std::exception&) {  // the daemon is gone: nobody is left to be told
  }
  for (const auto& [task, line] : unfinishedLine_) std::fprintf(stderr, "%s\n", line.c_str());
  if (!lost_) pvm_exit();
  removeRouteSockets();
}

int PvmLink::check(int code, const char* what) {
  if (code != PvmSysErr) return code;
  lost_ = true;
  throw LinkLost(std::string("the PVM daemon of this machine is gone (pvm_") + what + ")");
}

double PvmLink::now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool PvmLink::connected(TaskId peer) const {
  const auto found = peers_.find(peer);
  return found != peers_.end() && found->second.direct;
}

bool PvmLink::leaves(TaskId peer) const {
  const auto found = peers_.find(peer);
  return found != peers_.end() && (found->second.dead || found->second.ending != 0);
}

void PvmLink::connect(std::span<const TaskId> peers) {
  takeRouteNotices();
  for (const TaskId peer : peers) {
    if (self_ < peer && !connected(peer) && !leaves(peer)) sendEmpty(peer, kKnock);
  }
}

void PvmLink::send(TaskId to, std::span<const std::byte> packet) {
  if (packet.size() > static_cast<std::size_t>(kLargestPacket))
    throw std::length_error("packet of more than 1 GiB");
  if (!waitForRoom(to)) return;
  Peer& peer = peers_[to];
  std::uint32_t place = peer.sent++;
  check(pvm_initsend(PvmDataRaw), "initsend");
  check(pvm_pkuint(&place, 1, 1), "pkuint");
  // pvm_pkbyte reads only, though its type does not say so
  char* bytes = const_cast<char*>(reinterpret_cast<const char*>(packet.data()));
  check(pvm_pkbyte(bytes, static_cast<int>(packet.size()), 1), "pkbyte");
  check(pvm_send(number(to), kPacket), "send");
}

void PvmLink::takeRouteNotices() {
  while (check(pvm_nrecv(number(self_), kRoute), "nrecv") > 0) takeNotice(kRoute);
}

// False: the peer leaves, nothing is to be sent.  pvm_nrecv takes in what has come, so two tasks that send to each
// other do not wait for ever.
bool PvmLink::waitForRoom(TaskId task) {
  for (;;) {
    takeRouteNotices();
    if (leaves(task)) return false;
    const int route = peers_[task].route;
    if (route < 0) return true;
    std::vector<pollfd> sockets{{route, POLLOUT | POLLRDHUP, 0}};
    ::poll(sockets.data(), 1, 0);
    if ((sockets[0].revents & ~POLLOUT) != 0) {
      showsSignOfDeath(task);
      return false;
    }
    if (sockets[0].revents != 0) return true;
    int* descriptors = nullptr;
    const int count = check(pvm_getfds(&descriptors), "getfds");
    for (int i = 0; i < count; ++i) sockets.push_back({descriptors[i], POLLIN, 0});
    ::poll(sockets.data(), sockets.size(), -1);
  }
}

std::optional<LinkEvent> PvmLink::poll() {
  while (events_.empty()) {
    const int buffer = check(pvm_nrecv(-1, -1), "nrecv");
    if (buffer <= 0) break;
    take(buffer);
  }
  if (ending_ > 0 && events_.empty()) reapExpiredPeers();
  if (events_.empty()) return std::nullopt;
  LinkEvent event = std::move(events_.front());
  events_.pop_front();
  return event;
}

std::optional<LinkEvent> PvmLink::wait(double seconds) {
  const double end = now() + seconds;
  for (;;) {
    if (auto event = poll()) return event;  // first: a message may lie in libpvm with all sockets quiet
    double left = end - now();
    if (!(left > 0)) return std::nullopt;
    if (ending_ > 0) left = std::min(left, kSettleSeconds / 10);
    int* descriptors = nullptr;
    const int count = check(pvm_getfds(&descriptors), "getfds");  // each time: routes come and go
    std::vector<pollfd> sockets;
    for (int i = 0; i < count; ++i) sockets.push_back({descriptors[i], POLLIN, 0});
    ::poll(sockets.data(), sockets.size(), static_cast<int>(std::min(std::ceil(left * 1000), 1e9)));
  }
}

void PvmLink::watch(TaskId task) {
  Peer& peer = peers_[task];
  if (peer.watched) return;
  peer.watched = true;
  if (peer.dead)
    events_.push_back({LinkEvent::Kind::taskExit, task, {}, {}});
  else
    askForExit(task);
}

void PvmLink::askForExit(TaskId task) {
  Peer& peer = peers_[task];
  if (std::exchange(peer.asked, true)) return;
  int tid = number(task);
  check(pvm_notify(PvmTaskExit, kTaskExit, 1, &tid), "notify");
}

std::vector<HostInfo> PvmLink::hosts() {
  int count = 0, architectures = 0;
  pvmhostinfo* list = nullptr;
  std::vector<HostInfo> hosts;
  if (check(pvm_config(&count, &architectures, &list), "config") < 0) return hosts;
  const int own = pvm_tidtohost(number(self_));
  for (int i = 0; i < count; ++i) {
    if (silentHosts_.contains(list[i].hi_tid)) continue;
    const auto place = list[i].hi_tid == own ? hosts.begin() : hosts.end();
    hosts.insert(place, {list[i].hi_name, list[i].hi_speed});
  }
  return hosts;
}

// Asks to be told of the end of every host that was not known.
void PvmLink::learnHosts() {
  int count = 0, architectures = 0;
  pvmhostinfo* list = nullptr;
  if (check(pvm_config(&count, &architectures, &list), "config") < 0) return;
  for (int i = 0; i < count; ++i) {
    int daemon = list[i].hi_tid;
    if (hosts_.emplace(daemon, list[i].hi_name).second)
      check(pvm_notify(PvmHostDelete, kHostGone, 1, &daemon), "notify");
  }
}

Spawned PvmLink::spawn(Role role, const std::string& host) {
  for (const int daemon : silentHosts_) {
    if (const auto known = hosts_.find(daemon); known != hosts_.end() && known->second == host)
      return {kNobody, "host " + host + " does not answer"};  // PVM would wait for it for minutes
  }
  Command command = command_(role);
  const std::filesystem::path program = command.at(0);
  std::vector<char*> arguments;
  for (std::size_t i = 1; i < command.size(); ++i) arguments.push_back(command[i].data());
  arguments.push_back(nullptr);
  std::string where = host.empty() ? "." : host;
  const auto start = [&](std::string name) {
    int tid = 0;
    const int result =
        check(pvm_spawn(name.data(), arguments.data(), PvmTaskHost, where.data(), 1, &tid), "spawn");
    return result == 1 ? tid : result < 0 ? result : tid;
  };
  int tid = start(program.string());
  if (tid == PvmNoFile) tid = start(program.filename().string());  // by the host's own search path
  if (tid == PvmNoFile) {
    return {
        kNobody,
        "host " + (host.empty() ? "here" : host) + " has neither " + program.string() + " nor " +
            program.filename().string() +
            " in its search path (ep= in the host file, or PVM_PATH): build it there, or set RAYSHADE_TASKS"};
  }
  if (tid <= 0)
    return {kNobody,
            program.string() + " on host " + (host.empty() ? "here" : host) + ": " + whyNotStarted(tid)};
  const TaskId task{tid};
  peers_[task].child = true;
  askForExit(task);
  return {task, ""};
}

void PvmLink::kill(TaskId task) { check(endProcess(number(task)), "kill"); }

void PvmLink::take(int buffer) {
  int bytes = 0, tag = 0, sender = 0;
  if (pvm_bufinfo(buffer, &bytes, &tag, &sender) < 0) {
    ++refused_;
    return;
  }
  const bool told = fromDaemon(sender) || sender == number(self_);  // libpvm itself tells of routes
  switch (tag) {
    case kPacket:
      return takePacket(TaskId{sender}, bytes);
    case kKnock:
    case kComeIn:
    case kHello:
      return takeHello(TaskId{sender}, tag);
    case kTaskExit:
    case kRoute:
    case kHostGone:
    case kHostJoined:
      if (told) return takeNotice(tag);
      break;
    case kOutput:
      if (told) return takeOutput();
      break;
  }
  ++refused_;
}

void PvmLink::takePacket(TaskId from, int bytes) {
  Peer& peer = peers_[from];
  std::uint32_t place = 0;
  const int size = bytes - static_cast<int>(sizeof place);
  // After a death was told nothing may follow.
  bool good = !peer.dead && size >= 0 && size <= kLargestPacket && pvm_upkuint(&place, 1, 1) >= 0;
  Bytes packet;
  if (good) {
    packet.resize(static_cast<std::size_t>(size));
    good = pvm_upkbyte(reinterpret_cast<char*>(packet.data()), size, 1) >= 0 &&
           place - peer.taken < kNumbersAhead && !peer.early.contains(place);
  }
  if (!good) {
    ++refused_;
    return;
  }
  const auto deliver = [&](Bytes&& turn) {
    events_.push_back({LinkEvent::Kind::packet, from, {}, std::move(turn)});
    ++peer.taken;
  };
  if (place != peer.taken) {
    peer.early.emplace(place, std::move(packet));
    return;
  }
  deliver(std::move(packet));
  while (!peer.early.empty()) {
    auto next = peer.early.extract(peer.taken);
    if (next.empty()) break;
    deliver(std::move(next.mapped()));
  }
}

void PvmLink::takeHello(TaskId from, int tag) {
  if (number(from) <= 0 || from == self_) {
    ++refused_;
  } else if (tag == kKnock) {
    sendEmpty(from, kComeIn);
  } else if (tag == kComeIn) {
    if (self_ < from && !connected(from)) openRoute(from);
  } else {
    routeStands(from);
  }
}

void PvmLink::sendEmpty(TaskId to, int tag) {
  check(pvm_initsend(PvmDataRaw), "initsend");
  check(pvm_send(number(to), tag), "send");
}

void PvmLink::openRoute(TaskId peer) {
  pvm_setopt(PvmRoute, PvmRouteDirect);
  check(pvm_initsend(PvmDataRaw), "initsend");
  const int result = pvm_send(number(peer), kHello);
  pvm_setopt(PvmRoute, PvmAllowDirect);
  if (check(result, "send") >= 0) routeStands(peer);
}

void PvmLink::routeStands(TaskId task) {
  Peer& peer = peers_[task];
  if (peer.direct || peer.dead) return;
  peer.direct = true;
  hardenSockets();
  int tid = number(task);
  check(pvm_notify(PvmRouteDelete, kRoute, 1, &tid), "notify");
}

void PvmLink::takeNotice(int tag) {
  int id = 0;
  if (pvm_upkint(&id, 1, 1) < 0) {
    ++refused_;
    return;
  }
  if (tag == kHostJoined) {
    const auto before = hosts_;
    learnHosts();
    for (const auto& [daemon, name] : hosts_) {
      if (!before.contains(daemon)) events_.push_back({LinkEvent::Kind::hostJoined, kNobody, name, {}});
    }
  } else if (tag == kHostGone) {
    const auto host = hosts_.find(id);
    if (host == hosts_.end()) return;
    events_.push_back({LinkEvent::Kind::hostExit, kNobody, host->second, {}});
    hosts_.erase(host);
    silentHosts_.erase(id);
  } else if (tag == kRoute) {
    int descriptor = -1;  // none: the route is gone
    pvm_upkint(&descriptor, 1, 1);
    Peer& peer = peers_[TaskId{id}];
    peer.route = descriptor;
    if (descriptor >= 0) return;
    peer.direct = false;
    showsSignOfDeath(TaskId{id});
  } else if (const auto peer = peers_.find(TaskId{id}); peer != peers_.end()) {
    peer->second.exited = true;
    silentHosts_.erase(pvm_tidtohost(id));  // its daemon lives
    showsSignOfDeath(TaskId{id});
  }
}

// Each of exit and end of route can overtake packets that travel on the other way.
void PvmLink::showsSignOfDeath(TaskId task) {
  Peer& peer = peers_[task];
  if (peer.dead) return;
  if (peer.ending == 0) {
    peer.ending = now();
    ++ending_;
  }
  if (peer.exited && !peer.direct && peer.early.empty()) bury(task);
}

void PvmLink::reapExpiredPeers() {
  const double time = now();
  std::set<int> machines;
  for (const auto& [task, peer] : peers_) {
    if (!peer.dead && peer.ending != 0 && time - peer.ending > kSettleSeconds)
      machines.insert(pvm_tidtohost(number(task)));
  }
  // Who leaves the same machine a moment later is told with it: one recovery instead of several.
  for (const auto& [task, peer] : peers_) {
    if (!peer.dead && peer.ending != 0 && machines.contains(pvm_tidtohost(number(task)))) bury(task);
  }
}

void PvmLink::bury(TaskId task) {
  Peer& peer = peers_[task];
  peer.dead = true;
  peer.early.clear();
  --ending_;
  // The route ended and no daemon tells of an exit: the machine itself may be gone.
  if (peer.asked && !peer.exited) silentHosts_.insert(pvm_tidtohost(number(task)));
  if (peer.watched) events_.push_back({LinkEvent::Kind::taskExit, task, {}, {}});
}

// int task, int count: so many bytes of its output; 0 and less tell of begin and end.
void PvmLink::takeOutput() {
  int task = 0, count = 0;
  if (pvm_upkint(&task, 1, 1) < 0 || pvm_upkint(&count, 1, 1) < 0) {
    ++refused_;
    return;
  }
  if (count <= 0) {
    const auto rest = unfinishedLine_.extract(task);
    if (count == 0 && !rest.empty()) std::fprintf(stderr, "%s\n", rest.mapped().c_str());
    return;
  }
  std::string text;
  for (char part[1024]; count > 0; count -= static_cast<int>(sizeof part)) {
    const int size = std::min(count, static_cast<int>(sizeof part));
    if (pvm_upkbyte(part, size, 1) < 0) {
      ++refused_;
      break;
    }
    text.append(part, static_cast<std::size_t>(size));
  }
  std::string& line = unfinishedLine_[task];
  line += text;
  for (std::size_t end; (end = line.find('\n')) != std::string::npos; line.erase(0, end + 1))
    std::fprintf(stderr, "%.*s\n", static_cast<int>(end), line.c_str());
  if (line.size() > kLongestLine) std::fprintf(stderr, "%s\n", std::exchange(line, "").c_str());
  if (line.empty()) unfinishedLine_.erase(task);
}

}  // namespace rayshade
