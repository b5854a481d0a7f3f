// DensityGrid: how many objects are where, in bounded memory.
//
// Space is cut into cubes of side 2^k at multiples of 2^k; an object counts in the cube of its centre.  When
// more than `most` cubes are occupied, or a coordinate needs more than 20 bits, cubes are merged eight to one
// (k + 1).
//
// The cubes depend on the set of objects only, not on their order: k grows only when the objects so far do not
// fit, any larger set does not fit then either, so at the end k is the least that fits all of them; and
// merging gives the same counts as counting with the larger cubes from the start.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rayshade/base/bounds.h"

namespace rayshade {

class DensityGrid {
 public:
  // A cube holds centres of objects with index 2^k <= coordinate < (index + 1) 2^k on each axis.
  struct Cube {
    std::int32_t x, y, z;
    std::uint32_t count;
    friend auto operator<=>(const Cube&, const Cube&) = default;
  };

  // Fewer than eight cannot be promised: cubes at different sides of a coordinate plane never merge.
  explicit DensityGrid(std::size_t most = std::size_t{1} << 17) : most_(std::max<std::size_t>(most, 8)) {}

  // Empty and infinite bounds are not counted: such objects are nowhere, or everywhere.
  void add(const Bounds& bounds);

  // The occupied cubes, each once, in lexical order; at most `most`.
  std::span<const Cube> cubes();
  // The side of a cube.                                                                      [world units]
  double side() const;

  std::size_t bytes() const { return cubes_.capacity() * sizeof(Cube); }

 private:
  void merge();
  void coarsen(int steps);

  std::size_t most_;
  int exponent_ = -1000;     // k
  std::vector<Cube> cubes_;  // at most 2 most_ between calls; equal ones may occur until merge()
};

}  // namespace rayshade
