// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/program/host_options.h"

#include <cmath>
#include <cstdlib>
#include <limits>

#include "rayshade/program/option_values.h"

namespace rayshade {
namespace {

// 12c or 3.5; nothing: neither.
std::optional<Horizon> readHorizon(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool inCells = *end == 'c';
  if (end == text.c_str() || end[inCells ? 1 : 0] != '\0' || !(value >= 0 && std::isfinite(value)))
    return std::nullopt;
  return Horizon{inCells ? Horizon::Kind::cells : Horizon::Kind::distance, value};
}

CLI::Validator horizon() {
  return CLI::Validator(
      [](const std::string& text) {
        if (text == "auto" || readHorizon(text)) return std::string();
        return "`" + text + "` is neither auto, nor a number of cells (12c), nor a distance (3.5)";
      },
      "");
}

// Of what is known of the hosts, for one task.
std::uint64_t leastMemory(const HostMemories& memories) {
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (const auto& [host, memory] : memories)
    for (const std::uint64_t bytes : {memory.machine, memory.eachTask})
      if (bytes > 0) least = std::min(least, bytes);
  return least;
}

}  // namespace

std::string applySchedule(HostProgramOptions& o, const MachineSizes& machines, std::uint64_t bytes) {
  HostOptions& host = o.host;
  DemandPolicy& policy = host.policy;
  std::string why;
  const bool tasksSaid =
      host.wishes.voxels > 0 || o.pyramids || host.wishes.clusters > 1 || host.wishes.shades;
  // Tasks asked for by number get one thread each.
  host.threads = o.render.threads.value_or(o.schedule == "auto" && !tasksSaid ? 0 : 1);
  policy.shadeLocally = !o.shading || *o.shading == "local";
  // A voxel-trace task for each machine, and so many pyramid-trace tasks.
  const auto demandDriven = [&](unsigned pyramids) {
    if (host.wishes.voxels == 0)
      host.wishes.voxels = std::max(1u, machines.count / std::max(1u, host.wishes.clusters));
    host.wishes.pyramids = machines.count * std::max(1u, pyramids);
    policy.shadows = ShadowPolicy::automatic;
  };
  if (o.schedule == "auto" && tasksSaid) {
    policy.shadows = ShadowPolicy::automatic;
    why = "rays travel, for tasks were asked for by number";
  } else if (o.schedule == "auto" && bytes <= leastMemory(host.wishes.memory) / 4) {
    host.wishes.clusters = machines.count;
    host.wishes.voxels = 1;
    host.wishes.shades = 0;
    why = "each machine holds the whole scene, which is small against its memory, and traces tiles";
  } else if (o.schedule == "auto") {
    demandDriven(machines.cores - 1);
    why = "the scene is divided, for it is large against the memory of a machine";
  } else if (o.schedule == "hybrid") {
    demandDriven(machines.cores - 1);
  } else if (o.schedule == "pipelined") {
    demandDriven(machines.cores - 1);
    policy.horizon = {Horizon::Kind::cells, 1e9};
  } else if (o.schedule == "demand") {
    demandDriven(machines.cores);
    policy.horizon = {Horizon::Kind::cells, 1e9};
    policy.shadows = ShadowPolicy::local;
    policy.secondariesTravel = false;
  } else if (policy.shadeLocally) {
    policy.shadows = ShadowPolicy::automatic;
  }
  host.split = o.split == "cost" ? Split::cost : o.split == "equal" ? Split::equal : Split::balanced;
  // Every cluster has somebody to work for.
  if (host.wishes.pyramids > 0) host.wishes.pyramids = std::max(host.wishes.pyramids, host.wishes.clusters);
  if (o.pyramids) host.wishes.pyramids = *o.pyramids;
  if (o.shadows) {
    policy.shadows = *o.shadows == "forward" ? ShadowPolicy::forward
                     : *o.shadows == "local" ? ShadowPolicy::local
                                             : ShadowPolicy::automatic;
  }
  if (o.cacheMegabytes) policy.cacheBytes = static_cast<std::uint64_t>(*o.cacheMegabytes * 1e6);
  if (o.horizon && *o.horizon != "auto") policy.horizon = *readHorizon(*o.horizon);
  return why;
}

void declareHostOptions(CLI::App& app, HostProgramOptions& o) {
  declareOptions(app, o.render);
  const std::string tasks = "Tasks";
  app.add_option("--hosts", o.machine.hostFile, "PVM host file; without: this machine alone")
      ->type_name(kFile)
      ->check(CLI::ExistingFile)
      ->group(tasks);
  app.add_flag("--missing-hosts", o.machine.allowMissingHosts, "go on without hosts that do not answer")
      ->group(tasks);
  app.add_option("--voxels", o.host.wishes.voxels,
                 "voxel-trace tasks (default: two per host, with pyramid-trace tasks one)")
      ->check(wholeNumberFrom(1, 4096))
      ->group(tasks);
  app.add_option("--shades", o.host.wishes.shades, "shade tasks (default: one per four voxel-trace tasks)")
      ->check(wholeNumberFrom(1, 4096))
      ->group(tasks);
  app.add_option("--voxels-per-task", o.host.voxelsPerTask, "voxels that each voxel-trace task holds")
      ->check(wholeNumberFrom(1, 64))
      ->group(tasks);
  app.add_option("--split", o.split, "voxels of equal bytes (balanced), size or predicted cost")
      ->check(CLI::IsMember({"balanced", "equal", "cost"}))
      ->group(tasks);
  app.add_option("--pyramids", o.pyramids, "pyramid-trace tasks (default: for the cores that are left)")
      ->check(wholeNumberFrom(0, 4096))
      ->group(tasks);
  app.add_option("--clusters", o.host.wishes.clusters,
                 "copies of the model, each distributed over voxel-trace tasks")
      ->check(wholeNumberFrom(1, 64))
      ->group(tasks);
  const std::string sharing = "What travels: rays or objects";
  app.add_option("--schedule", o.schedule,
                 "auto: by the size of the scene and the machines; data: rays travel; hybrid: primary "
                 "and shadow rays are traced where they begin, with "
                 "fetched cells; "
                 "pipelined: more of that, farther; demand: every ray, nothing travels but objects")
      ->check(CLI::IsMember({"auto", "data", "hybrid", "pipelined", "demand"}))
      ->group(sharing);
  app.add_option("--horizon", o.horizon,
                 "how far pyramids go: auto, a number of cells (12c), a distance (3.5)")
      ->check(horizon())
      ->group(sharing);
  app.add_option("--shadows", o.shadows, "shadow rays: forward, local or auto")
      ->check(CLI::IsMember({"forward", "local", "auto"}))
      ->group(sharing);
  app.add_option("--shading", o.shading,
                 "local: by the task that found the hit, if nothing of it leaves (default); separate: always "
                 "by shade "
                 "tasks, as in the paper")
      ->check(CLI::IsMember({"separate", "local"}))
      ->group(sharing);
  app.add_option("--cache", o.cacheMegabytes, "object cache of each task, in MB")
      ->transform(numberFrom(0.001, 1e9))
      ->group(sharing);
  app.add_option("--cells", o.host.cells, "cells of the bin-tree, about (default: by the size of the scene)")
      ->check(wholeNumberFrom(1, 1 << 22))
      ->group(sharing);
  app.add_option("--tile", o.host.tilePixels, "pixels of a pyramid, about")
      ->check(wholeNumberFrom(1, 65536))
      ->group(sharing);
  app.add_flag("--dynamic-shading", o.host.dynamicShading, "choose shade tasks by how busy they are")
      ->group(tasks);
  app.add_option("--window", o.host.window,
                 "samples on their way at a time (default: by the number of tasks)")
      ->check(wholeNumberFrom(1, 1 << 24))
      ->group(tasks);
  app.add_option("--patience", o.patience,
                 "seconds of silence after which a task that renders counts as hanging (default: 30)")
      ->transform(numberFrom(0.1, 1e6))
      ->group(tasks);
  app.add_flag("--plan", o.plan, "render nothing: print which tasks would run where and why")->group(tasks);
  app.add_option("--table", o.tableFile, "write what each task did to this file, as tab-separated values")
      ->type_name(kFile)
      ->check(notEmpty())
      ->group(tasks);
  app.add_flag("--mixed", o.host.mixedArithmetic, "go on when hosts compute different bits")->group(tasks);
}

}  // namespace rayshade
