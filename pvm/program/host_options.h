// The command line of rayshade-host: that of rayshade, and what concerns tasks.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/link/virtual_machine.h"
#include "pvm/schedule/options.h"
#include "rayshade/program/options.h"

namespace rayshade {

struct HostProgramOptions {
  Options render;
  HostOptions host;
  MachineOptions machine;
  bool plan = false;
  std::string tableFile;
  std::string schedule = "auto", split = "balanced";
  std::optional<std::uint32_t> pyramids;
  std::optional<std::string> horizon, shadows, shading;
  std::optional<double> cacheMegabytes;
  double patience = HostOptions{}.killAfter;
};

void declareHostOptions(CLI::App& app, HostProgramOptions& options);

struct MachineSizes {
  std::uint32_t count = 1;
  unsigned cores = 1;  // of each; taken to be those of the host task's own
};
// What the named schedule means on so many machines, whose memory is among the wishes, for a model of so many bytes; what is said in
// detail counts more.  Answers with the reason where the program chose.
std::string applySchedule(HostProgramOptions& options, const MachineSizes& machines, std::uint64_t bytes);

}  // namespace rayshade
