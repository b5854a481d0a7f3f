// Random numbers of all magnitudes, and directions, places and shares that hurt: exactly along an axis or nearly so, far
// away, right at an end.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/support/random.h"

namespace rayshade {

inline constexpr double kUnit = 0x1p-53;
inline constexpr double kLeast = 1e-8, kMost = 1e8;

class HardRandom : public Random {
 public:
  HardRandom(std::uint64_t seed, std::uint64_t number) : Random(mixBits(seed) + number) {}
  double sign() { return oneIn(2) ? 1 : -1; }
  Vec3 axis() {
    Vec3 a;
    a[below(3)] = sign();
    return a;
  }
  Vec3 axisOrNearly() {
    if (oneIn(3)) return axis();
    if (oneIn(2)) return normalize(axis() + magnitude(1e-17, 1) * direction());
    return direction();
  }
  Vec3 across(Vec3 n) {  // a unit vector at right angles to n
    const Basis b = basisAround(n);
    const double turn = oneIn(4) ? 0 : real(0, 6.283185307);
    return normalize(std::cos(turn) * b.first + std::sin(turn) * b.second);
  }
  double size() { return magnitude(kLeast, kMost); }
  Vec3 placeOf(double size) {
    switch (below(4)) {
      case 0:
        return {};
      case 1:
        return magnitude(kLeast, kMost) * direction();
      default:
        return size * magnitude(1e-2, 1e3) * direction();
    }
  }
  // Often 0, 1 or a half.
  double share() { return oneIn(3) ? below(3) / 2.0 : real(); }
};

}  // namespace rayshade
