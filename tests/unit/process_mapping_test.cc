// Figure 6 of the paper: which task runs where.
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/schedule/process_mapping.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace rayshade {
namespace {

std::vector<HostInfo> equalHosts(std::size_t count) {
  std::vector<HostInfo> hosts;
  for (std::size_t i = 0; i < count; ++i) hosts.push_back({"host" + std::to_string(i), 1000});
  return hosts;
}

// How many tasks of a role each host has.
std::map<std::string, int> perHost(const std::vector<Placement>& placements, Role role) {
  std::map<std::string, int> count;
  for (const Placement& p : placements)
    if (p.role == role) ++count[p.host];
  return count;
}
int total(const std::map<std::string, int>& count) {
  int sum = 0;
  for (const auto& [host, n] : count) sum += n;
  return sum;
}

TEST(ProcessMapping, OneHostHasEverything) {
  const auto placements = mapProcesses(equalHosts(1), {});
  for (const Placement& p : placements) EXPECT_EQ(p.host, "host0");
  EXPECT_EQ(total(perHost(placements, Role::voxelTrace)), 2);
  EXPECT_EQ(total(perHost(placements, Role::pyramidTrace)), 0);
  EXPECT_EQ(total(perHost(placements, Role::shade)), 1);
}

TEST(ProcessMapping, UnsaidNumbersAreTwoVoxelTasksAHostAndAShadeTaskForFour) {
  const auto placements = mapProcesses(equalHosts(8), {});
  EXPECT_EQ(total(perHost(placements, Role::voxelTrace)), 16);
  EXPECT_EQ(total(perHost(placements, Role::shade)), 4);
}

TEST(ProcessMapping, ThereAreAsManyTasksAsWishedNumberedFromZero) {
  const auto placements = mapProcesses(equalHosts(3), {.voxels = 5, .pyramids = 3, .shades = 2});
  std::map<Role, std::uint32_t> next;
  for (const Placement& p : placements) {
    EXPECT_EQ(p.index, next[p.role]++);
    EXPECT_FALSE(p.reason.empty());
  }
  EXPECT_EQ(next[Role::voxelTrace], 5u);
  EXPECT_EQ(next[Role::pyramidTrace], 3u);
  EXPECT_EQ(next[Role::shade], 2u);
  EXPECT_FALSE(next.contains(Role::host)) << "the host task runs already";
}

TEST(ProcessMapping, VoxelTasksSpreadEvenlyOverEqualHosts) {
  for (std::size_t hosts = 1; hosts <= 9; ++hosts)
    for (std::uint32_t voxels = 1; voxels <= 20; ++voxels) {
      const auto placements = mapProcesses(equalHosts(hosts), {.voxels = voxels});
      const auto count = perHost(placements, Role::voxelTrace);
      int most = 0, least = count.size() < hosts ? 0 : 1000;
      for (const auto& [host, n] : count) {
        most = std::max(most, n);
        least = std::min(least, n);
      }
      EXPECT_LE(most - least, 1) << voxels << " voxel tasks on " << hosts << " hosts";
    }
}

TEST(ProcessMapping, FewerVoxelTasksThanHostsLeaveTheHostTaskAlone) {
  const auto count = perHost(mapProcesses(equalHosts(3), {.voxels = 2}), Role::voxelTrace);
  EXPECT_FALSE(count.contains("host0"));
  EXPECT_EQ(count.size(), 2u);
}

// Slow: (k + 0.3) / 1, fast: k / 3; with eight tasks 2 : 6 keeps both below 2.3.
TEST(ProcessMapping, FasterHostsGetMoreVoxelTasksInProportion) {
  auto count = perHost(mapProcesses({{"slow", 1000}, {"fast", 3000}}, {.voxels = 8}), Role::voxelTrace);
  EXPECT_EQ(count["slow"], 2);
  EXPECT_EQ(count["fast"], 6);
}

TEST(ProcessMapping, PyramidTasksAreCloseToTheHostTask) {
  const auto placements = mapProcesses(equalHosts(4), {.voxels = 8, .pyramids = 2});
  EXPECT_EQ(perHost(placements, Role::pyramidTrace), (std::map<std::string, int>{{"host0", 2}}));
}

TEST(ProcessMapping, PyramidTasksGoElsewhereWhenTheHostTasksMachineHasEnoughToDo) {
  const auto count = perHost(mapProcesses(equalHosts(4), {.voxels = 4, .pyramids = 8}), Role::pyramidTrace);
  EXPECT_GT(count.size(), 1u);
  EXPECT_TRUE(count.contains("host0"));
  const auto slow =
      perHost(mapProcesses({{"old", 100}, {"new", 1000}}, {.voxels = 2, .pyramids = 1}), Role::pyramidTrace);
  EXPECT_EQ(slow, (std::map<std::string, int>{{"new", 1}}));
}

TEST(ProcessMapping, ShadeTasksAreWhereLeastTracingIsExpected) {
  // Three voxel tasks and the host task on three hosts: the one with the host task has the most to do.
  const auto even = perHost(mapProcesses(equalHosts(3), {.voxels = 3, .shades = 2}), Role::shade);
  EXPECT_EQ(even, (std::map<std::string, int>{{"host1", 1}, {"host2", 1}}));
  // Four voxel tasks leave two hosts with one of them; host0 has the host task besides, host1 got the second one.
  const auto uneven = perHost(mapProcesses(equalHosts(3), {.voxels = 4, .shades = 1}), Role::shade);
  EXPECT_EQ(uneven, (std::map<std::string, int>{{"host2", 1}}));
}

TEST(ProcessMapping, EveryClusterHasAllOfItsVoxelTasks) {
  EXPECT_EQ(total(perHost(mapProcesses(equalHosts(4), {.voxels = 3, .clusters = 2}), Role::voxelTrace)), 6);
  // Not said: two per host, shared among the clusters, at least one each.
  EXPECT_EQ(total(perHost(mapProcesses(equalHosts(4), {.clusters = 2}), Role::voxelTrace)), 8);
  EXPECT_EQ(total(perHost(mapProcesses(equalHosts(4), {.clusters = 3}), Role::voxelTrace)), 6);
  EXPECT_EQ(total(perHost(mapProcesses(equalHosts(1), {.clusters = 5}), Role::voxelTrace)), 5);
  EXPECT_EQ(total(perHost(mapProcesses(equalHosts(1), {.clusters = 0}), Role::voxelTrace)), 2);
}

TEST(ProcessMapping, OfALostHostNothingIsLeft) {
  std::vector<HostInfo> hosts = equalHosts(4);
  hosts.erase(hosts.begin() + 2);
  const auto placements = mapProcesses(hosts, {.voxels = 8, .pyramids = 2, .shades = 3});
  EXPECT_EQ(placements.size(), 13u);
  for (const Placement& p : placements) EXPECT_NE(p.host, "host2");
}

TEST(ProcessMapping, ASpeedOfNothingIsNoTrap) {
  const auto placements = mapProcesses({{"a", 0}, {"b", -5}, {"c", 1000}}, {.voxels = 4});
  EXPECT_EQ(perHost(placements, Role::voxelTrace)["c"], 2);
}

TEST(ProcessMapping, AFastHostDoesNotGetTheWholeModel) {
  const std::vector<HostInfo> hosts{{"slow", 1000}, {"fast", 4000}};
  EXPECT_EQ(perHost(mapProcesses(hosts, {.voxels = 2}), Role::voxelTrace),
            (std::map<std::string, int>{{"slow", 1}, {"fast", 1}}));
  EXPECT_EQ(perHost(mapProcesses(hosts, {.voxels = 4}), Role::voxelTrace)["fast"], 3);
}

TEST(ProcessMapping, HostsWithMoreMemoryGetMoreVoxelTasks) {
  Wishes wishes{.voxels = 8};
  wishes.memory = {{"host0", {kHostTaskBytes + 100'000'000, 0}}, {"host1", {700'000'000, 0}}};
  const auto count = perHost(mapProcesses(equalHosts(2), wishes), Role::voxelTrace);
  EXPECT_EQ(count, (std::map<std::string, int>{{"host0", 1}, {"host1", 7}}));
  // Room for the host task is left on its own machine.
  wishes.memory = {{"host0", {kHostTaskBytes + 1, 0}}, {"host1", {kHostTaskBytes, 0}}};
  EXPECT_EQ(perHost(mapProcesses(equalHosts(2), wishes), Role::voxelTrace)["host0"], 1);
}

}  // namespace
}  // namespace rayshade
