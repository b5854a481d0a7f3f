// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/simulation/network.h"

#include <algorithm>

namespace rayshade {

// A row of a mesh that is not full has routers all the same.
Network::Network(const NetworkSpec& spec, std::uint32_t hosts)
    : spec_(spec), parts_(4 * ((hosts + spec.columns - 1) / spec.columns) * spec.columns), inside_(hosts) {}

Nanoseconds Network::take(Part& part, Nanoseconds now, Nanoseconds span) {
  const Nanoseconds begin = std::max(now, part.free);
  part.free = begin + span;
  return begin;
}

// Along the row first, then along the column.
Network::Part& Network::nextLine(Journey& packet) {
  const std::uint32_t column = packet.at % spec_.columns, wanted = packet.to % spec_.columns;
  const std::uint32_t from = packet.at;
  enum : std::uint32_t { east, west, south, north } direction;
  if (column < wanted) {
    direction = east;
    packet.at += 1;
  } else if (column > wanted) {
    direction = west;
    packet.at -= 1;
  } else if (packet.at < packet.to) {
    direction = south;
    packet.at += spec_.columns;
  } else {
    direction = north;
    packet.at -= spec_.columns;
  }
  return parts_[4 * from + direction];
}

Network::Passed Network::pass(Journey& packet, Nanoseconds now) {
  const auto bytes = static_cast<double>(packet.bytes);
  if (packet.from == packet.to) {
    const Nanoseconds span = toNanoseconds(bytes / spec_.localBandwidth);
    return {take(inside_[packet.from], now, span) + span + toNanoseconds(spec_.localLatency), true};
  }
  const Nanoseconds span = toNanoseconds(spec_.gap + bytes / spec_.bandwidth),
                    latency = toNanoseconds(spec_.latency);
  const bool first = packet.parts++ == 0;
  switch (spec_.kind) {
    case NetworkSpec::Kind::networkSwitch:
      if (first) return {take(parts_[4 * packet.from], now, span) + latency, false};
      return {take(parts_[4 * packet.to + 1], now, span) + span, true};
    case NetworkSpec::Kind::shared:
      return {take(parts_[0], now, span) + span + latency, true};
    case NetworkSpec::Kind::mesh:
      break;
  }
  const Nanoseconds begin = take(nextLine(packet), now, span);
  const bool arrived = packet.at == packet.to;
  return {begin + latency + (arrived ? span : 0), arrived};
}

}  // namespace rayshade
