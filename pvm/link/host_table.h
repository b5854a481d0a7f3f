// The machines of the virtual machine, as far as a task knows them; and those of which nothing is asked any more.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>

#include "pvm/link/daemon.h"

namespace rayshade {

class HostTable {
 public:
  explicit HostTable(Daemon& daemon) : daemon_(daemon) {}

  // Asks to be told of the end of every host that was not known; says which those are.
  std::map<int, std::string> learn();
  std::optional<std::string> remove(int daemon);  // its name, if it was known

  // A machine that seems to be gone: PVM would wait for it for minutes.
  void seemsGone(int daemon) { silent_.insert(daemon); }
  void lives(int daemon) { silent_.erase(daemon); }
  bool silent(const std::string& host) const;
  // Those that are there now, without the silent ones; that of `self` first.
  std::vector<HostInfo> answering(TaskId self) const;

 private:
  Daemon& daemon_;
  std::map<int, std::string> names_;  // by the id of the daemon
  std::set<int> silent_;              // daemons
};

}  // namespace rayshade
