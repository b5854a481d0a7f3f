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
  std::string schedule = "data", split = "balanced";
  std::optional<std::uint32_t> pyramids;
  std::optional<std::string> horizon, shadows, shading;
  std::optional<double> cacheMegabytes;
  double patience = HostOptions{}.killAfter;
};

void declareHostOptions(CLI::App& app, HostProgramOptions& options);

// What the named schedule means on so many hosts; what is said in detail counts more.
void applySchedule(HostProgramOptions& options, std::uint32_t hosts);

}  // namespace rayshade
