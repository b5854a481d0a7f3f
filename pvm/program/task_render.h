// A render by tasks, from the command line to the picture and the tables: the same on real and on simulated machines.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/host/host_task.h"
#include "pvm/program/host_options.h"

namespace rayshade {

// Where the tasks are to run.
class Stage {
 public:
  virtual ~Stage() = default;
  // The hosts that there would be; changes and starts nothing.
  virtual std::vector<HostInfo> planned() = 0;
  // Starts, or finds, the machine.
  virtual Machine& start() = 0;
  // Ends what was started, whatever has happened.
  virtual void end() {}
  virtual unsigned cores() = 0;  // of each host
  virtual HostMemories memories(const std::string& ownName) = 0;
  // The host task that runs there.
  virtual void hasHost(const HostTask&) {}
  // A place to which no picture can be written without a name; empty: it can.
  virtual std::string console() { return {}; }
};

// Reads what was said on the command line, if it was right, and what is in the scene, renders, and gives the exit status.
int runTaskRender(const std::string& program, HostProgramOptions& options, Stage& stage);

}  // namespace rayshade
