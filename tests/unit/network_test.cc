// Packets between simulated hosts: how long they take, and what they wait for.
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/simulation/network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace rayshade {
namespace {

// 1000 bytes occupy a part for 10 + 100 microseconds.
NetworkSpec specOf(NetworkSpec::Kind kind) {
  NetworkSpec spec;
  spec.kind = kind;
  spec.columns = 4;
  spec.latency = 20e-6;
  spec.gap = 10e-6;
  spec.bandwidth = 1e7;
  spec.localLatency = 5e-6;
  spec.localBandwidth = 1e9;
  return spec;
}

struct Sent {
  std::uint32_t from, to;
  Nanoseconds at;
};

// When each of these arrives, of 1000 bytes; they go on in the order of their times.
std::vector<Nanoseconds> arrivals(const NetworkSpec& spec, const std::vector<Sent>& sent) {
  Network network(spec, 16);
  struct Open {
    std::size_t index;
    Journey journey;
    Nanoseconds at;
  };
  std::vector<Open> open;
  for (std::size_t i = 0; i < sent.size(); ++i)
    open.push_back({i, {sent[i].from, sent[i].to, sent[i].from, 0, 1000}, sent[i].at});
  std::vector<Nanoseconds> arrived(sent.size());
  while (!open.empty()) {
    const auto next =
        std::min_element(open.begin(), open.end(), [](const Open& a, const Open& b) { return a.at < b.at; });
    const Network::Passed passed = network.pass(next->journey, next->at);
    next->at = passed.at;
    if (!passed.arrived) continue;
    arrived[next->index] = passed.at;
    open.erase(next);
  }
  return arrived;
}

TEST(Network, ASwitchHasACardForEachHostAndEachWay) {
  const NetworkSpec spec = specOf(NetworkSpec::Kind::networkSwitch);
  EXPECT_EQ(arrivals(spec, {{0, 1, 0}}), (std::vector<Nanoseconds>{130'000}));
  // One after the other out of one host, or into one host; side by side otherwise.
  EXPECT_EQ(arrivals(spec, {{0, 1, 0}, {0, 2, 0}}), (std::vector<Nanoseconds>{130'000, 240'000}));
  EXPECT_EQ(arrivals(spec, {{0, 2, 0}, {1, 2, 0}}), (std::vector<Nanoseconds>{130'000, 240'000}));
  EXPECT_EQ(arrivals(spec, {{0, 1, 0}, {1, 0, 0}, {2, 3, 0}}),
            (std::vector<Nanoseconds>{130'000, 130'000, 130'000}));
}

TEST(Network, AMediumTakesOnePacketAtATime) {
  EXPECT_EQ(arrivals(specOf(NetworkSpec::Kind::shared), {{0, 1, 0}, {2, 3, 0}, {1, 0, 300'000}}),
            (std::vector<Nanoseconds>{130'000, 240'000, 430'000}));
}

TEST(Network, InAMeshPacketsGoAlongRowsFirstAndMeetOnLines) {
  const NetworkSpec spec = specOf(NetworkSpec::Kind::mesh);
  // From 0 to 15, rows of four: six steps.
  EXPECT_EQ(arrivals(spec, {{0, 15, 0}}), (std::vector<Nanoseconds>{6 * 20'000 + 110'000}));
  EXPECT_EQ(arrivals(spec, {{15, 0, 0}}), (std::vector<Nanoseconds>{6 * 20'000 + 110'000}));
  // Both need the line from 1 to 2; the first has it when the second comes.
  EXPECT_EQ(arrivals(spec, {{1, 2, 0}, {0, 2, 0}}),
            (std::vector<Nanoseconds>{130'000, 110'000 + 20'000 + 110'000}));
  // 4 to 5 lies elsewhere.
  EXPECT_EQ(arrivals(spec, {{1, 2, 0}, {4, 5, 0}}), (std::vector<Nanoseconds>{130'000, 130'000}));
}

TEST(Network, WithinAHostNothingOfItIsUsed) {
  EXPECT_EQ(arrivals(specOf(NetworkSpec::Kind::shared), {{0, 1, 0}, {2, 2, 0}}),
            (std::vector<Nanoseconds>{130'000, 6'000}));
}

}  // namespace
}  // namespace rayshade
