// Random numbers for tests: the same for the same seed, on every machine.
//
// tests/support/seeded_random.h is the same and says its seed beside every failure.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

#include "rayshade/base/bounds.h"
#include "rayshade/base/random.h"
#include "rayshade/base/vec.h"

namespace rayshade {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(mixBits(seed)) {}

  std::uint64_t bits() { return mixBits(state_ += 0x9e3779b97f4a7c15u); }  // SplitMix64
  double real() { return static_cast<double>(bits() >> 11) * 0x1p-53; }    // in [0, 1)
  double real(double low, double high) { return low + (high - low) * real(); }
  double magnitude(double least, double most) {  // every power of ten as often
    return std::exp(real(std::log(least), std::log(most)));
  }
  // Both ends may come.
  int integer(int low, int high) { return low + below(high - low + 1); }
  template <std::integral T>
  T below(T count) {
    return static_cast<T>(bits() % static_cast<std::uint64_t>(count));
  }
  bool oneIn(int count) { return below(count) == 0; }
  bool chance(double probability) { return real() < probability; }

  // In a cube, in a box, with whole coordinates.
  Vec3 point(double low, double high) {
    const double x = real(low, high), y = real(low, high), z = real(low, high);
    return {x, y, z};
  }
  Vec3 point(const Bounds& box) {
    const double x = real(box.low.x, box.high.x), y = real(box.low.y, box.high.y),
                 z = real(box.low.z, box.high.z);
    return {x, y, z};
  }
  Vec3 lattice(int low, int high) {
    const double x = integer(low, high), y = integer(low, high), z = integer(low, high);
    return {x, y, z};
  }
  // Of length 1, none preferred.
  Vec3 direction() {
    const double z = real(-1, 1), turn = real(0, 6.283185307), r = std::sqrt(1 - z * z);
    return {r * std::cos(turn), r * std::sin(turn), z};
  }

  template <class List>
  const auto& pick(const List& choices) {
    return choices[below(choices.size())];
  }
  template <class T>
  T pick(std::initializer_list<T> choices) {
    return choices.begin()[below(choices.size())];
  }

  template <class T>
  void shuffle(std::vector<T>& list) {
    for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[below(i)]);
  }

 private:
  std::uint64_t state_;
};

}  // namespace rayshade
