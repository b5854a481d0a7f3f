// A machine to be simulated: hosts that are all alike, and what connects them.  Files of such machines: hosts/machines.
//
// The network is LogGP (Alexandrov, Ionescu, Schauser and Scheiman 1995): a packet occupies each part of its way for `gap` and its
// bytes over the bandwidth, and arrives `latency` after it has left; the overheads of sender and receiver are processor time.
// Seconds and bytes.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace rayshade {

struct NetworkSpec {
  enum class Kind : std::uint8_t {
    networkSwitch,  // one card for each host, which sends and receives at a time
    shared,         // one medium for all
    mesh,           // of `columns`; each host is connected with its neighbours, packets go along rows first
  } kind = Kind::networkSwitch;
  std::uint32_t columns = 1;
  double latency = 0;   // of a mesh: of each step
  double overhead = 0;  // of sender and receiver, for each packet, beyond what the unit costs say
  double gap = 0;
  double bandwidth = 1;                         // of a card, the medium, or a line of a mesh, one way
  double localLatency = 0, localBandwidth = 1;  // within a host
};

struct MachineSpec {
  std::uint32_t hosts = 1, cores = 1;
  double speed = 1;          // of one core, against that of the unit costs
  std::uint64_t memory = 0;  // of a host; 0: nothing is known
  NetworkSpec network;
  std::string costs;  // the file of the unit costs
};

// Throws std::runtime_error: file, line and what is wrong.
MachineSpec readMachine(const std::string& fileName);

}  // namespace rayshade
