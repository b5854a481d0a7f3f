// The virtual machine of this user: finding it, starting it, halting what was started.
//
// libpvm waits 12 s on the address file of a daemon that has died, a second daemon beside a living one runs
// on unseen, and a host that does not join is no error.  So: look at the socket first, start the daemon
// oneself, and compare the hosts that are there with the hosts that were asked for.
//
// A machine started here lives no longer than its VirtualMachine, whatever ends this process: the daemon is
// a child that the kernel tells of our death.  One that was there before is used and left as it is, except
// that hosts of the host file which it does not have are added.  libpvm remembers the first PVM_TMP that it saw:
// one process can use one directory only, though one machine after another in it.
// Times in seconds.  Source: manual pages pvmd3(1), pvm_intro(1PVM), pvm_addhosts(3PVM); pvm 3.4.6.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "pvm/link/host_file.h"

namespace rayshade {

// One line: what is wrong and what to do.
class MachineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class MachineState {
  none,     // no address file
  alive,    // a daemon answers
  stale,    // a daemon has died and left its file; ours to remove
  foreign,  // the file or the daemon belongs to somebody else: this place is no use
};

// Takes milliseconds and calls nothing of libpvm.
MachineState lookForMachine();

// Does a name of a host file mean this machine: by its name or by an address that it has?
bool isThisMachine(const std::string& name);

// The path of the daemon, or "" when PVM is not installed.
std::string daemonProgram();

// libpvm leaves the names of the sockets at which direct routes were opened; takes away those of this process and of
// processes that have ended, where nobody listens.
void removeRouteSockets();

struct MachineOptions {
  std::string hostFile;            // "": this machine alone, not reachable from the network
  bool allowMissingHosts = false;  // go on with those that joined
};

class VirtualMachine {
 public:
  // Finds or starts; afterwards this process is enrolled.  Throws MachineError.
  explicit VirtualMachine(const MachineOptions& options);
  VirtualMachine(const VirtualMachine&) = delete;
  VirtualMachine& operator=(const VirtualMachine&) = delete;
  ~VirtualMachine();

  bool startedHere() const { return daemon_ > 0; }
  const std::vector<std::string>& missingHosts() const { return missing_; }  // empty unless they were allowed

  // Ends the machine with all its tasks, if it was started here, and removes its files.  PvmLinks must be
  // gone.
  void halt();

 private:
  void start(const std::string& hostFile, const std::string& ownName);
  void joinHosts(const std::vector<HostLine>& wanted, const MachineOptions& options);

  pid_t daemon_ = 0;              // 0: not ours
  std::string privateDirectory_;  // "": the usual place
  std::vector<std::string> missing_;
};

}  // namespace rayshade
