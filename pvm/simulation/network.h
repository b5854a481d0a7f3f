// Packets on their way between simulated hosts, with what they wait for on it (machine_file.h).
//
// A way is a row of parts: cards, the medium, or the lines of a mesh.  A part takes one packet after the other, in the order in which
// they come to it; so packets from one host to another stay in order.  The head of a packet goes on before its tail has come in.
// Times in nanoseconds.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pvm/simulation/machine_file.h"

namespace rayshade {

using Nanoseconds = std::int64_t;

constexpr Nanoseconds toNanoseconds(double seconds) {
  return static_cast<Nanoseconds>(seconds * 1e9 + (seconds < 0 ? -0.5 : 0.5));
}
constexpr double toSeconds(Nanoseconds time) { return 1e-9 * static_cast<double>(time); }

// Where a packet is.
struct Journey {
  std::uint32_t from = 0, to = 0;  // hosts
  std::uint32_t at = 0;            // in a mesh: the host that it has reached
  std::uint32_t parts = 0;         // that it has passed
  std::size_t bytes = 0;
};

class Network {
 public:
  explicit Network(const NetworkSpec& spec, std::uint32_t hosts);

  // The packet comes to the next part of its way; when it comes to the one after that, or arrives.
  struct Passed {
    Nanoseconds at = 0;
    bool arrived = false;
  };
  Passed pass(Journey& packet, Nanoseconds now);

 private:
  struct Part {
    Nanoseconds free = 0;  // from then on
  };
  // Takes the packet as soon as it can; when it begins to.
  static Nanoseconds take(Part& part, Nanoseconds now, Nanoseconds span);
  Part& nextLine(Journey& packet);

  NetworkSpec spec_;
  std::vector<Part> parts_;  // cards: out and in of each host; lines of a mesh: four of each host; the medium
  std::vector<Part> inside_;  // of each host
};

}  // namespace rayshade
