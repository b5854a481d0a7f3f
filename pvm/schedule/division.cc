// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/schedule/division.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "rayshade/base/memory.h"
#include "rayshade/space/cost.h"

namespace rayshade {
namespace {

// A cell is what is fetched at a time: a small part of a cache, and of a scene, and large enough to be worth a message.
constexpr std::uint64_t kObjectsPerCell = 8192, kLeastObjectsPerCell = 64, kMostCells = 1 << 16;
constexpr double kCellsPerCache = 32;  // on average; no cell takes more than a sixteenth, as a rule
constexpr std::uint64_t kCellsPerScene = 32;
// Where nothing is fetched, cells only say where there is anything.
constexpr std::uint64_t kObjectsPerBox = 4, kMostBoxes = 4096;
// Objects in several voxels are held more than once: by measurement no more than this, in parts of all.
constexpr double kCopies = 1.2;

// Equal shares of `bytes`, as far as the rooms go: what is too much for small ones is shared out among the others.
std::vector<double> sharesOf(double bytes, const std::vector<double>& rooms) {
  std::vector<std::size_t> order(rooms.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rooms[a] < rooms[b]; });
  std::vector<double> shares(rooms.size());
  double left = bytes;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double equal = left / static_cast<double>(order.size() - i);
    shares[order[i]] = std::max(std::min(rooms[order[i]], equal), 1e-6 * bytes);
    left = std::max(0.0, left - shares[order[i]]);
  }
  return shares;
}

std::vector<Portion> portionsOf(const Survey& survey, const std::vector<TaskPlace>& places,
                                std::uint32_t voxels) {
  std::vector<double> rooms;
  for (const TaskPlace& place : places)
    rooms.push_back(place.room == TaskPlace::kUnknown
                        ? kInfinity
                        : static_cast<double>(place.room) - static_cast<double>(survey.everywhere));
  const std::vector<double> shares = sharesOf(
      kCopies * static_cast<double>(std::max<std::uint64_t>(survey.bytes - survey.everywhere, 1)), rooms);
  std::vector<Portion> portions;
  for (std::uint32_t voxel = 0; voxel < voxels; ++voxel)
    portions.push_back({shares[voxel % places.size()], places[voxel % places.size()].speed});
  return portions;
}

std::vector<Division::Held> expectedOf(const Survey& survey, const Division& division, std::size_t tasks) {
  std::vector<Division::Held> held(tasks, {0, static_cast<double>(survey.everywhere)});
  std::vector<VoxelId> voxels;
  std::vector<std::uint32_t> owners;
  for (const BoundsSample::Box& box : survey.held.boxes()) {
    voxels.clear();
    owners.clear();
    voxelsTouching(division.tree, box.bounds, voxels);
    for (const VoxelId voxel : voxels) owners.push_back(division.owners[number(voxel)]);
    std::sort(owners.begin(), owners.end());
    owners.erase(std::unique(owners.begin(), owners.end()), owners.end());
    for (const std::uint32_t owner : owners) {
      held[owner].objects += box.weight;
      held[owner].bytes += box.weight * box.size;
    }
  }
  return held;
}

std::uint64_t cellsToFetch(const Survey& survey, std::uint64_t cacheBytes) {
  const double byCache = kCellsPerCache * static_cast<double>(survey.bytes) /
                         static_cast<double>(std::max<std::uint64_t>(cacheBytes, 1));
  const std::uint64_t most = std::min(survey.objects / kLeastObjectsPerCell, kMostCells);
  const std::uint64_t least = std::max(survey.objects / kObjectsPerCell, kCellsPerScene);
  return std::min(most, std::max(least, static_cast<std::uint64_t>(std::min(byCache, 1e9))));
}

}  // namespace

std::vector<TaskPlace> placesOfVoxelTasks(const std::vector<HostInfo>& hosts,
                                          const std::vector<Placement>& placements, const Wishes& wishes) {
  std::vector<TaskPlace> places;
  const std::uint32_t clusters = std::max(1u, wishes.clusters);
  const auto voxelTasks =
      static_cast<std::uint32_t>(std::ranges::count(placements, Role::voxelTrace, &Placement::role));
  places.resize(std::max(1u, voxelTasks / clusters));
  for (TaskPlace& place : places) place.speed = kInfinity;
  for (std::size_t i = 0; i < hosts.size(); ++i) {
    const HostInfo& host = hosts[i];
    const auto isHere = [&](const Placement& p) { return p.host == host.name; };
    const auto all = static_cast<double>(std::ranges::count_if(placements, isHere));
    const auto tracing = static_cast<double>(std::ranges::count_if(
        placements, [&](const Placement& p) { return isHere(p) && p.role == Role::voxelTrace; }));
    if (tracing == 0) continue;
    double room = kInfinity;
    if (const auto known = wishes.memory.find(host.name); known != wishes.memory.end()) {
      const HostMemory& memory = known->second;
      const double others = (i == 0 ? kHostTaskBytes : 0) + (all - tracing) * kPeak * kTaskBytes;
      if (memory.machine > 0) room = (static_cast<double>(memory.machine) - others) / tracing;
      if (memory.eachTask > 0) room = std::min(room, static_cast<double>(memory.eachTask));
    }
    for (const Placement& p : placements) {
      if (!isHere(p) || p.role != Role::voxelTrace) continue;
      TaskPlace& place = places[p.index % places.size()];
      if (place.host.empty() || room / kPeak - kTaskBytes < static_cast<double>(place.room)) {
        place.host = host.name;
        if (room < kInfinity)
          place.room = static_cast<std::uint64_t>(std::max(0.0, room / kPeak - kTaskBytes));
      }
      place.speed = std::min(place.speed, std::max(host.speed, 1) / tracing);
    }
  }
  for (TaskPlace& place : places)
    if (!(place.speed < kInfinity)) place.speed = 1;  // its host is gone
  return places;
}

Division divideSpace(Survey& survey, const FrameRequest& request, const SceneSettings& settings,
                     const HostOptions& options, const std::vector<TaskPlace>& places) {
  const auto tasks = static_cast<std::uint32_t>(places.size());
  const std::uint32_t voxels = std::min(tasks * std::max(1u, options.voxelsPerTask), kMaxVoxels);
  const bool fetches = options.wishes.pyramids > 0 || options.policy.shadows != ShadowPolicy::forward;
  const std::uint64_t bySize = fetches ? cellsToFetch(survey, options.policy.cacheBytes)
                                       : std::min<std::uint64_t>(survey.objects / kObjectsPerBox, kMostBoxes);
  const std::uint32_t wanted = options.cells > 0 ? options.cells : static_cast<std::uint32_t>(bySize);
  const std::uint32_t cells = std::max(wanted, voxels);
  Division division;
  std::vector<CostBox> costs;
  if (options.split != Split::equal && voxels > 1)
    costs = predictCost(survey.world, survey.sample, request.view, request.picture, settings);
  if (options.split == Split::balanced) {
    std::vector<HeldBox> held;
    if (voxels > 1)
      for (const BoundsSample::Box& box : survey.held.boxes())
        held.push_back({box.bounds, box.weight * box.size, box.weight});
    division.tree = buildBalancedTree(survey.world, cells, survey.density, held, std::move(costs),
                                      portionsOf(survey, places, voxels));
  } else {
    division.tree =
        buildBinTree(survey.world, {.voxels = voxels, .cells = cells}, survey.density, std::move(costs));
  }
  for (std::uint32_t voxel = 0; voxel < voxelCount(division.tree); ++voxel)
    division.owners.push_back(voxel % tasks);
  division.expected = expectedOf(survey, division, places.size());
  for (const WholeThings& things : survey.whole)
    division.largestWhole = std::max(division.largestWhole, things.largest);
  return division;
}

std::string whatDoesNotFit(const Division& division, const std::vector<TaskPlace>& places) {
  // Without what is only needed for a while: that it cannot fit is to be certain.
  const auto roomOf = [&](std::size_t task) {
    const std::uint64_t room = places[task].room;
    return room == TaskPlace::kUnknown ? kInfinity
                                       : (static_cast<double>(room) + kTaskBytes) * kPeak - kTaskBytes;
  };
  const auto lack = [&](std::size_t task) { return division.expected[task].bytes - roomOf(task); };
  double all = 0, missing = 0;
  std::size_t worst = 0;
  for (std::size_t task = 0; task < places.size(); ++task) {
    all += division.expected[task].bytes;
    missing += std::max(0.0, lack(task));
    if (lack(task) > lack(worst)) worst = task;
  }
  if (!(missing > 0)) return "";
  std::string text = "not enough memory for the scene: its objects take about " + sayBytes(all) +
                     " in the voxel-trace tasks; task " + std::to_string(worst) + " on " +
                     places[worst].host + " would hold " + sayBytes(division.expected[worst].bytes) +
                     " and has room for " + sayBytes(roomOf(worst)) + "; about " + sayBytes(kPeak * missing) +
                     " more memory is needed, on these hosts or on more of them";
  if (static_cast<double>(division.largestWhole) > roomOf(worst))
    text +=
        "; one thing that cannot be divided takes " + sayBytes(static_cast<double>(division.largestWhole));
  return text;
}

}  // namespace rayshade
