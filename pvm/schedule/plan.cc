// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/schedule/plan.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdarg>

#include "rayshade/base/memory.h"

namespace rayshade {
namespace {

[[gnu::format(printf, 2, 3)]] void add(std::string& text, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  va_list again;
  va_copy(again, arguments);
  std::string piece(static_cast<std::size_t>(std::max(0, std::vsnprintf(nullptr, 0, format, arguments))),
                    '\0');
  std::vsnprintf(piece.data(), piece.size() + 1, format, again);
  va_end(again);
  va_end(arguments);
  text += piece;
}

std::string describe(const Horizon& horizon) {
  switch (horizon.kind) {
    case Horizon::Kind::cells:
      return horizon.value >= 1e9 ? "as far as the rays go"
                                  : "for " + std::to_string(std::lround(horizon.value)) + " cells";
    case Horizon::Kind::distance:
      return "up to " + std::to_string(horizon.value) + " world units from the eye";
    case Horizon::Kind::automatic:
      break;
  }
  return "as long as fetching a cell pays";
}

// What stays whole: a task that needs a part of it holds all of it.
void addWhole(std::string& text, const Survey& survey) {
  const char* const names[] = {"CSG operations", "named objects", "height fields", "images"};
  const char* lead = "held whole     ";
  for (std::size_t kind = 0; kind < survey.whole.size(); ++kind) {
    const WholeThings& things = survey.whole[kind];
    if (things.count == 0) continue;
    add(text, "%s %" PRIu64 " %s of %.3f MB, the largest %.3f MB\n", lead, things.count, names[kind],
        megabytes(things.bytes), megabytes(things.largest));
    lead = "               ";
  }
}

// Who traces what, by the policy and by what the scene has.  `tasks`: voxel-trace tasks of a cluster.
void addPolicy(std::string& text, const HostOptions& options, const SceneSettings& settings,
               std::uint32_t tasks) {
  const DemandPolicy& policy = options.policy;
  if (options.wishes.pyramids == 0 && tasks == 1 && policy.shadeLocally) {
    add(text,
        "all rays        in tiles of about %u pixels, by a task that holds all that there is, with %s\n",
        options.tilePixels,
        options.threads == 0   ? "a thread for each core"
        : options.threads == 1 ? "one thread"
                               : (std::to_string(options.threads) + " threads").c_str());
    return;
  }
  if (options.wishes.pyramids == 0) {
    add(text, "primary rays    travel from voxel to voxel: no pyramid tasks\n");
  } else {
    add(text, "primary rays    in pyramids of about %u pixels, with fetched cells %s\n", options.tilePixels,
        describe(policy.horizon).c_str());
  }
  std::size_t areas = 0, casting = 0;
  for (const LightSource& light : settings.lights) {
    areas += pointsOf(light) > 1;
    casting += light.castsShadows;
  }
  if (!settings.shadows || casting == 0) {
    add(text, "shadow rays     none: no light casts shadows\n");
  } else {
    const char* how = policy.shadows == ShadowPolicy::forward ? "travel from voxel to voxel"
                      : policy.shadows == ShadowPolicy::local
                          ? "where the hit was found, with fetched cells"
                          : "where the hit was found if fetching pays, else they travel";
    add(text, "shadow rays     %s; to %zu lights, %zu of them areas\n", how, casting, areas);
  }
  add(text, "other rays      %s\n",
      policy.secondariesTravel || options.wishes.pyramids == 0 ? "travel from voxel to voxel"
                                                               : "in the pyramid task that found the hit");
  add(text, "shading         %s\n",
      policy.shadeLocally
          ? "where all colours come from the task that found the hit, by that task; else by shade tasks"
          : "by shade tasks");
}

}  // namespace

std::vector<HostInfo> hostsAfterJoining(std::vector<HostInfo> running, const std::vector<HostLine>& lines,
                                        const std::function<bool(const std::string&)>& isThisMachine,
                                        const std::string& ownName) {
  if (running.empty()) {
    const auto own =
        std::find_if(lines.begin(), lines.end(), [&](const HostLine& l) { return isThisMachine(l.name); });
    running.push_back(own == lines.end() ? HostInfo{ownName} : HostInfo{own->name, own->speed});
  }
  for (const HostLine& line : lines) {
    const bool known =
        isThisMachine(line.name) ||
        std::any_of(running.begin(), running.end(), [&](const HostInfo& h) { return h.name == line.name; });
    if (!known) running.push_back({line.name, line.speed});
  }
  return running;
}

std::string describePlan(const std::vector<HostInfo>& hosts, HostOptions options, Survey survey,
                         const FrameRequest& request, const SceneSettings& settings, const SceneWork& work) {
  NeededTasks needed = neededTasks(work, options, hosts.size());
  options.wishes = needed.wishes;
  const std::vector<Placement> placements = mapProcesses(hosts, options.wishes);
  const auto voxelTasks = static_cast<std::uint32_t>(std::count_if(
      placements.begin(), placements.end(), [](const Placement& p) { return p.role == Role::voxelTrace; }));
  const std::uint32_t clusters = std::max(1u, options.wishes.clusters), perCluster = voxelTasks / clusters;
  const std::vector<TaskPlace> places = placesOfVoxelTasks(hosts, placements, options.wishes);
  const Division division = divideSpace(survey, request, settings, options, places);

  std::string text;
  add(text, "%" PRIu64 " objects of %.1f MB in %u voxels of equal %s and %u cells; %u cluster%s\n",
      survey.objects, megabytes(survey.bytes), voxelCount(division.tree),
      options.split == Split::balanced ? "bytes"
      : options.split == Split::cost   ? "predicted work"
                                       : "size",
      cellCount(division.tree), clusters, clusters > 1 ? "s" : "");
  addPolicy(text, options, settings, perCluster);
  addWhole(text, survey);

  add(text, "\n%-21s %-16s %9s %8s  %s\n", "task", "host", "objects", "MB", "why there");
  add(text, "%-21s %-16s %9s %8s  %s\n", "host 0", hosts[0].name.c_str(), "-", "-", "where it is started");
  for (const Placement& p : placements) {
    const std::string name = roleName(p.role) + " " + std::to_string(p.index);
    std::string objects = "-", bytes = "-";
    if (p.role == Role::voxelTrace) {
      const Division::Held& held = division.expected[p.index % perCluster];
      objects = "~" + std::to_string(std::llround(held.objects));
      bytes.clear();
      add(bytes, "~%.1f", 1e-6 * held.bytes);
    }
    add(text, "%-21s %-16s %9s %8s  %s\n", name.c_str(), p.host.c_str(), objects.c_str(), bytes.c_str(),
        p.reason.c_str());
  }
  for (const std::string& less : needed.why) add(text, "%s\n", less.c_str());

  // Work in parts of a voxel task's, for a machine of usual speed.
  add(text, "\n%-21s %-16s %9s %9s  %s\n", "host", "speed", "memory MB", "tasks",
      "expected work for its speed");
  for (std::size_t i = 0; i < hosts.size(); ++i) {
    double work = i == 0 ? expectedWork(Role::host) : 0;
    int tasks = i == 0 ? 1 : 0;
    for (const Placement& p : placements) {
      if (p.host != hosts[i].name) continue;
      work += expectedWork(p.role);
      ++tasks;
    }
    const auto known = options.wishes.memory.find(hosts[i].name);
    const bool said = known != options.wishes.memory.end() && known->second.machine > 0;
    const std::string memory = said ? std::to_string(known->second.machine / 1'000'000) : "?";
    add(text, "%-21s %-16d %9s %9d  %.2f\n", hosts[i].name.c_str(), hosts[i].speed, memory.c_str(), tasks,
        work * HostInfo{}.speed / std::max(hosts[i].speed, 1));
  }
  if (const std::string problem = whatDoesNotFit(division, places); !problem.empty())
    add(text, "\nwarning: %s\n", problem.c_str());
  return text;
}

}  // namespace rayshade
