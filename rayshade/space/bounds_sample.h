// BoundsSample: a few thousand boxes that stand for all objects of a scene, however many there are.
//
// A sample of the objects' bounds, drawn with priorities: object number i with surface area a has the priority a / u(i),
// u uniform in (0, 1] and a hash of the number; kept are those with the highest priorities.  Each stands for the area
// max(a, t), t being the highest priority that was not kept: sums over the sample are unbiased estimates of sums over
// all objects, and large objects are always in.
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
  };

  explicit BoundsSample(std::size_t most = 4096) : most_(std::max<std::size_t>(most, 1)) {}

  // Empty and infinite bounds are left out, and points, which no ray hits.
  void add(const Bounds& bounds);

  // In the order in which they were added.
  std::vector<Box> boxes() const;

 private:
  struct Kept {
    double priority;
    std::uint64_t number;
    Bounds bounds;
  };

  std::size_t most_;
  std::uint64_t count_ = 0;
  double threshold_ = 0;    // the highest priority that was not kept
  std::vector<Kept> kept_;  // a heap, the lowest priority on top
};

}  // namespace rayshade
