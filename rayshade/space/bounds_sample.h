// BoundsSample: some thousand boxes that stand for all objects of a scene, however many there are.
//
// A sample of the objects' bounds, drawn with priorities: object number i of size s - its surface area, or its bytes - has
// the priority s / u(i), u uniform in (0, 1] and a hash of the number; kept are those with the highest priorities.  Each
// stands for the size max(s, t), t being the highest priority that was not kept: sums over the sample are unbiased estimates
// of sums over all objects, and large objects are always in.
// Source: Duffield, Lund & Thorup 2007, Priority sampling for estimation of arbitrary subset sums.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "rayshade/base/bounds.h"

namespace rayshade {

class BoundsSample {
 public:
  struct Box {
    Bounds bounds;
    double weight = 1;  // so many boxes like this one it stands for
    double size = 0;    // its own
  };

  explicit BoundsSample(std::size_t most = 4096) : most_(std::max<std::size_t>(most, 1)) {}

  // Empty and infinite bounds are left out, and what has no size.
  void add(const Bounds& bounds, double size);
  void add(const Bounds& bounds) { add(bounds, surfaceArea(bounds)); }

  // In the order in which they were added.
  std::vector<Box> boxes() const;

 private:
  static double surfaceArea(const Bounds& bounds);
  struct Kept {
    double priority;
    std::uint64_t number;
    Bounds bounds;
    double size;
  };

  std::size_t most_;
  std::uint64_t count_ = 0;
  double threshold_ = 0;    // the highest priority that was not kept
  std::vector<Kept> kept_;  // a heap, the lowest priority on top
};

}  // namespace rayshade
