// Random numbers for tests: the same for the same seed, on every machine.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/random.h"
#include "rayshade/base/vec.h"

namespace rayshade {

class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : key_{mixBits(seed)} {}
  double real(double low, double high) {
    return low + (high - low) * uniform(key_, Dimension::jitterX, ++count_);
  }
  Vec3 point(double low, double high) {
    const double x = real(low, high), y = real(low, high), z = real(low, high);
    return {x, y, z};
  }

 private:
  RandomKey key_;
  std::uint32_t count_ = 0;
};

}  // namespace rayshade
