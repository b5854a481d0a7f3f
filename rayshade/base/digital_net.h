// Points that fill the unit cube evenly: scrambled digital nets of side x side points, any coordinate of any point by itself.
//
// The digits of a point's number, times a matrix for each coordinate, are the digits of the coordinate.  Every slice of the
// cube as fine as the number of points allows then has its share of them, for two coordinates together as for each alone.
//
//   side a power of 2        Sobol's matrices (Joe & Kuo 2008), and the number itself backwards as the first coordinate
//   of 3, 5 or 7             Faure's: the number is a polynomial, shifted by 0, 1, 2, ..; backwards as the first
//   anything else            the first side^2 points of Sobol's sequence
//
// The digits are scrambled as Owen says, each by a permutation that a hash of key and higher digits chooses, and what follows
// them is uniform: each point alone is uniform in the cube, so means are without bias, and their variance is never much above
// that of independent points.  Affine permutations d -> a d + b do: of two digits they make any two with equal chance.
// Coordinates beyond those that a base has are those of an independent net, in an order of its own.
//
// Sources: Niederreiter, Random Number Generation and Quasi-Monte Carlo Methods, 1992, chapter 4; Owen, Randomly Permuted
// (t,m,s)-Nets and (t,s)-Sequences, 1995; Joe & Kuo, Constructing Sobol Sequences with Better Two-Dimensional Projections, 2008;
// Burley, Practical Hash-based Owen Scrambling, 2020, for scrambling by hashes and for nets in an order of their own.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "rayshade/base/random.h"

namespace rayshade {

struct SquarePoint {  // in [0, 1)^2
  double x = 0, y = 0;
};

class DigitalNet {
 public:
  static constexpr std::int32_t kMostSide = 64;

  // Requires 1 <= side <= kMostSide.
  static const DigitalNet& of(std::int32_t side);

  std::uint32_t size() const { return size_; }
  // Coordinates that belong together; those beyond are of other nets.
  std::uint32_t coordinates() const;

  // Of point `number` < size(), in [0, 1).  `key` is that of a use: all points of a net are asked for with the same.
  double coordinate(std::uint32_t number, std::uint32_t coordinate, RandomKey key) const;
  // Two, of keys that belong to one use; `coordinate` is the first.
  SquarePoint square(std::uint32_t number, std::uint32_t coordinate, RandomKey key) const;

 private:
  constexpr explicit DigitalNet(std::int32_t side);
  bool isWhole() const { return size_ == power_; }
  std::uint32_t digitsOf(std::uint32_t number, std::uint32_t coordinate) const;
  std::uint32_t scrambled(std::uint32_t value, RandomKey key) const;
  double coordinate(std::uint32_t number, std::uint32_t coordinate, RandomKey key,
                    std::uint32_t behind) const;

  std::uint32_t size_ = 1, power_ = 1;  // power of the base
  std::uint8_t base_ = 2, digits_ = 0;
};

}  // namespace rayshade
