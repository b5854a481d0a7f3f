// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/daemon.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <pvm3.h>
#include <sys/socket.h>

namespace rayshade {
namespace {

constexpr int kSocketBytes = 512 * 1024;  // as far as the system allows
constexpr int kSilenceSeconds = 10;       // a machine that acknowledges nothing for so long is dead

}  // namespace

int daemonOf(TaskId task) { return pvm_tidtohost(number(task)); }

int Daemon::check(int code, const char* what) {
  if (code != PvmSysErr) return code;
  lost_ = true;
  throw LinkLost(std::string("the PVM daemon of this machine is gone (pvm_") + what + ")");
}

void Daemon::sendEmpty(TaskId to, Tag tag) {
  check(pvm_initsend(PvmDataRaw), "initsend");
  check(pvm_send(number(to), number(tag)), "send");
}

void Daemon::notify(int event, Tag tag, int id) { check(pvm_notify(event, number(tag), 1, &id), "notify"); }

void Daemon::addSockets(std::vector<pollfd>& sockets) {
  int* descriptors = nullptr;
  const int count = check(pvm_getfds(&descriptors), "getfds");
  for (int i = 0; i < count; ++i) sockets.push_back({descriptors[i], POLLIN, 0});
}

void Daemon::hardenSockets() {
  std::vector<pollfd> sockets;
  addSockets(sockets);
  for (const pollfd& socket : sockets) hardenSocket(socket.fd);
}

void hardenSocket(int socket) {
  const auto set = [socket](int level, int option, int value) {
    setsockopt(socket, level, option, &value, sizeof value);  // what is refused is not needed
  };
  fcntl(socket, F_SETFD, FD_CLOEXEC);
  set(SOL_SOCKET, SO_SNDBUF, kSocketBytes);
  set(SOL_SOCKET, SO_RCVBUF, kSocketBytes);
  int domain = 0;
  socklen_t size = sizeof domain;
  if (getsockopt(socket, SOL_SOCKET, SO_DOMAIN, &domain, &size) != 0 || domain != AF_INET) return;
  set(SOL_SOCKET, SO_KEEPALIVE, 1);
  set(IPPROTO_TCP, TCP_KEEPIDLE, kSilenceSeconds / 2);
  set(IPPROTO_TCP, TCP_KEEPINTVL, 1);
  set(IPPROTO_TCP, TCP_KEEPCNT, kSilenceSeconds / 2);
  set(IPPROTO_TCP, TCP_USER_TIMEOUT, kSilenceSeconds * 1000);
}

}  // namespace rayshade
