// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/simulation/machine_file.h"

#include <filesystem>

#include "pvm/simulation/figures.h"

namespace rayshade {
namespace {

NetworkSpec::Kind kindOf(Figures& figures) {
  const std::string kind = figures.takeWord("network");
  if (kind == "switch") return NetworkSpec::Kind::networkSwitch;
  if (kind == "shared") return NetworkSpec::Kind::shared;
  if (kind == "mesh") return NetworkSpec::Kind::mesh;
  figures.complain("network", "must be switch, shared or mesh");
}

}  // namespace

MachineSpec readMachine(const std::string& fileName) {
  constexpr double kMostHosts = 1 << 16, kMostCores = 1024, kMostSeconds = 100, kMostBytes = 1e18;
  Figures figures(fileName);
  MachineSpec machine;
  machine.hosts = static_cast<std::uint32_t>(figures.take("hosts", 1, kMostHosts));
  machine.cores = static_cast<std::uint32_t>(figures.take("cores", 1, kMostCores));
  machine.speed = figures.take("speed", 1e-9, 1e9);
  machine.memory = static_cast<std::uint64_t>(figures.take("memory", 0, kMostBytes));
  NetworkSpec& network = machine.network;
  network.kind = kindOf(figures);
  if (network.kind == NetworkSpec::Kind::mesh)
    network.columns = static_cast<std::uint32_t>(figures.take("columns", 1, machine.hosts));
  network.latency = figures.take("latency", 0, kMostSeconds);
  network.overhead = figures.take("overhead", 0, kMostSeconds);
  network.gap = figures.take("gap", 0, kMostSeconds);
  network.bandwidth = figures.take("bandwidth", 1, kMostBytes);
  network.localLatency = figures.take("local-latency", 0, kMostSeconds);
  network.localBandwidth = figures.take("local-bandwidth", 1, kMostBytes);
  machine.costs = (std::filesystem::path(fileName).parent_path() / figures.takeWord("costs")).string();
  figures.finish();
  return machine;
}

}  // namespace rayshade
