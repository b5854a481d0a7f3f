// Machines to be simulated, as files.
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/simulation/machine_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "pvm/simulation/unit_costs.h"
#include "tests/support/scratch_directory.h"

namespace rayshade {
namespace {

constexpr const char* kMachine =
    "# a comment\nhosts 3\ncores 2   # and another\nspeed 0.5\nmemory 1e9\nnetwork mesh\ncolumns 2\nlatency "
    "1e-6\n"
    "overhead 2e-6\ngap 0\nbandwidth 1e6\nlocal-latency 0\nlocal-bandwidth 1e9\ncosts costs\n";

std::string problemOf(const std::string& text) {
  const ScratchDirectory scratch("machine");
  std::ofstream(scratch / "machine") << text;
  try {
    readMachine(scratch / "machine");
  } catch (const std::runtime_error& error) {
    return std::string(error.what()).substr((scratch / "machine").size());
  }
  return "";
}

std::string with(const std::string& line, const std::string& instead) {
  std::string text = kMachine;
  return text.replace(text.find(line), line.size(), instead);
}

TEST(MachineFile, IsReadLineByLine) {
  const ScratchDirectory scratch("machine");
  std::ofstream(scratch / "machine") << kMachine;
  const MachineSpec machine = readMachine(scratch / "machine");
  EXPECT_EQ(machine.hosts, 3u);
  EXPECT_EQ(machine.cores, 2u);
  EXPECT_EQ(machine.speed, 0.5);
  EXPECT_EQ(machine.network.kind, NetworkSpec::Kind::mesh);
  EXPECT_EQ(machine.network.columns, 2u);
  EXPECT_EQ(machine.costs, scratch / "costs");
}

TEST(MachineFile, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(problemOf(kMachine), "");
  EXPECT_EQ(problemOf(with("hosts 3", "hosts many")), ":2: hosts must be a number from 1 to 65536");
  EXPECT_EQ(problemOf(with("hosts 3", "hosts")), ":2: hosts has no value");
  EXPECT_EQ(problemOf(with("speed 0.5", "hosts 4")), ":4: hosts is said twice");
  EXPECT_EQ(problemOf(with("speed 0.5", "")), ": speed is missing");
  EXPECT_EQ(problemOf(with("speed 0.5", "speed nan")), ":4: speed must be a number from 1e-09 to 1e+09");
  EXPECT_EQ(problemOf(with("network mesh", "network ring")), ":6: network must be switch, shared or mesh");
  EXPECT_EQ(problemOf(with("columns 2", "columns 4")), ":7: columns must be a number from 1 to 3");
  EXPECT_EQ(problemOf(std::string(kMachine) + "colour 3\n"), ":15: colour is not known here");
}

TEST(MachineFile, ThoseInTheTreeAreGood) {
  int machines = 0;
  for (const auto& entry : std::filesystem::directory_iterator("hosts/machines")) {
    if (entry.path().filename() == "costs") continue;
    ++machines;
    const MachineSpec machine = readMachine(entry.path());
    const UnitCosts costs = readUnitCosts(machine.costs);
    EXPECT_GT(*std::max_element(costs.nanoseconds.begin(), costs.nanoseconds.end()), 0) << entry.path();
  }
  EXPECT_GE(machines, 6);
}

}  // namespace
}  // namespace rayshade
