// Random numbers that say their seed beside every failure for as long as they live.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

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

}  // namespace rayshade
