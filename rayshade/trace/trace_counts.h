// What is counted while tracing.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace rayshade {

struct TraceCounts {
  std::uint64_t primaryRays = 0, transmittedRays = 0, reflectedRays = 0, shadowRays = 0;
  std::uint64_t visits = 0;  // of a region by a ray
  std::uint64_t hits = 0;    // of rays that are not shadow rays
  std::uint64_t tests = 0;   // objects tested by rays, shadow rays included
};

inline TraceCounts operator+(TraceCounts a, const TraceCounts& b) {
  a.primaryRays += b.primaryRays;
  a.transmittedRays += b.transmittedRays;
  a.reflectedRays += b.reflectedRays;
  a.shadowRays += b.shadowRays;
  a.visits += b.visits;
  a.hits += b.hits;
  a.tests += b.tests;
  return a;
}
template <class Archive>
void serialize(Archive& archive, TraceCounts& c) {
  archive(c.primaryRays, c.transmittedRays, c.reflectedRays, c.shadowRays, c.visits, c.hits, c.tests);
}

}  // namespace rayshade
