// Random numbers that say their seed beside every failure for as long as they live.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "tests/support/random.h"

namespace rayshade {

class SeededRandom : public Random {
 public:
  explicit SeededRandom(std::uint64_t seed, const char* file = __builtin_FILE(), int line = __builtin_LINE())
      : Random(seed), trace_(file, line, "random numbers of seed " + std::to_string(seed)) {}

 private:
  testing::ScopedTrace trace_;
};

// How many seeds a test goes through: RAYSHADE_TEST_SEEDS says it for all of them.
inline std::uint64_t seedCount(std::uint64_t usual) {
  const char* asked = std::getenv("RAYSHADE_TEST_SEEDS");
  return asked != nullptr ? std::strtoull(asked, nullptr, 10) : usual;
}

}  // namespace rayshade
