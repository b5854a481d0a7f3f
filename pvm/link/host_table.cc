// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/host_table.h"

#include <pvm3.h>

namespace rayshade {
namespace {

std::span<pvmhostinfo> configuration(Daemon& daemon) {
  int count = 0, architectures = 0;
  pvmhostinfo* list = nullptr;
  if (daemon.check(pvm_config(&count, &architectures, &list), "config") < 0) return {};
  return {list, static_cast<std::size_t>(count)};
}

}  // namespace

std::map<int, std::string> HostTable::learn() {
  std::map<int, std::string> learned;
  for (const pvmhostinfo& host : configuration(daemon_)) {
    if (!names_.emplace(host.hi_tid, host.hi_name).second) continue;
    learned.emplace(host.hi_tid, host.hi_name);
    daemon_.notify(PvmHostDelete, Tag::hostGone, host.hi_tid);
  }
  return learned;
}

std::optional<std::string> HostTable::remove(int daemon) {
  auto host = names_.extract(daemon);
  if (host.empty()) return std::nullopt;
  silent_.erase(daemon);
  return std::move(host.mapped());
}

bool HostTable::silent(const std::string& host) const {
  for (const int daemon : silent_) {
    if (const auto known = names_.find(daemon); known != names_.end() && known->second == host) return true;
  }
  return false;
}

std::vector<HostInfo> HostTable::answering(TaskId self) const {
  std::vector<HostInfo> hosts;
  for (const pvmhostinfo& host : configuration(daemon_)) {
    if (silent_.contains(host.hi_tid)) continue;
    const auto place = host.hi_tid == daemonOf(self) ? hosts.begin() : hosts.end();
    hosts.insert(place, {host.hi_name, host.hi_speed});
  }
  return hosts;
}

}  // namespace rayshade
