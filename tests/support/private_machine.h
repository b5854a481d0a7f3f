// A PVM virtual machine for one test, in a directory of its own: it meets no other machine of this user, and nothing
// of it stays.
//
// All machines of one process use the same directory, one after another, because libpvm remembers the first
// PVM_TMP that it saw.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "pvm/link/virtual_machine.h"
#include "tests/support/scratch_directory.h"

namespace rayshade {

class PrivateMachine {
 public:
  static bool possible() { return !daemonProgram().empty(); }  // else: GTEST_SKIP() << kImpossible
  static constexpr const char* kImpossible = "pvmd is not installed (Debian: apt-get install pvm)";

  PrivateMachine() {
    std::filesystem::permissions(directory_.path(), std::filesystem::perms::owner_all);
    setenv("PVM_TMP", directory_.path().c_str(), 1);
    setenv("PVM_VMID", "test", 1);
    unsetenv("PVMSOCK");
  }
  PrivateMachine(const PrivateMachine&) = delete;
  PrivateMachine& operator=(const PrivateMachine&) = delete;
  ~PrivateMachine() { halt(); }

  VirtualMachine& start(const MachineOptions& options = {}) { return machine_.emplace(options); }
  void halt() { machine_.reset(); }
  const std::string& directory() const { return directory_.path(); }
  bool nothingLeft() const {  // of all machines that there were
    return !std::filesystem::exists(directory()) || std::filesystem::is_empty(directory());
  }
  std::string addressFile() const { return directory_ / "pvmd." + std::to_string(getuid()) + ".test"; }

 private:
  ScratchDirectory directory_{"test"};
  std::optional<VirtualMachine> machine_;
};

}  // namespace rayshade
