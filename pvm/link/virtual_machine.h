// The virtual machine of this user: finding it, starting it, halting what was started.
//
// A second daemon beside a living one runs on unseen, and a host that does not join is no error.  So: look at the socket
// first (daemon_files.h), start the daemon oneself (daemon_process.h), and compare the hosts that are there with those of
// the host file.
//
// A machine started here lives no longer than its VirtualMachine, whatever ends this process: the daemon is
// a child that the kernel tells of our death.  One that was there before is used and left as it is, except
// that hosts of the host file which it does not have are added.  libpvm remembers the first PVM_TMP that it saw:
// one process can use one directory only, though one machine after another in it.
// Times in seconds.  Source: manual pages pvmd3(1), pvm_intro(1PVM), pvm_addhosts(3PVM); pvm 3.4.6.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pvm/link/daemon_files.h"
#include "pvm/link/daemon_process.h"
#include "pvm/link/host_file.h"

namespace rayshade {

// Does a name of a host file mean this machine: by its name or by an address that it has?
bool isThisMachine(const std::string& name);

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
  void joinHosts(const std::vector<HostLine>& wanted, const MachineOptions& options);

  pid_t daemon_ = 0;              // 0: not ours
  std::string privateDirectory_;  // "": the usual place
  std::vector<std::string> missing_;
};

}  // namespace rayshade
