// The oracle: kernels against the exact answer, on rays that are meant to hurt.
//
// A case is a function of class, seed and number.  Sizes and places are log-uniform over 1e-8..1e8 (as in the shape tests
// of pbrt-v4); rays are aimed at vertices, edges, tangents, planes of cuts, along axes and nearly so, from far, near and
// inside, and leave a surface that was hit the way the renderer leaves it (originOff).
//
// Inputs are doubles, so a place is known to about one rounding of the largest number in play.  With u = 2^-53 and
// M = |origin| + |t| + reach of the shape the bound of a class is b = kBound u M, kBound = 16 as in rayshade/shapes/shape.h (blobs 128).
// A failure is
//   phantom   the kernel's t is a point farther than b from the surface, or beyond its rim by more than b / |n.d|
//   missed    the exact line crosses the surface so that no motion of it by b can undo that - 4 b / |n.d| before and after
//             it is b away from the surface, on different sides, and the rim is as far - and the kernel says nothing there
//   pointOff  pointAt() is farther from the surface (its rim aside) than the error that it states
//   selfHit   a ray that leaves a surface meets it again at once, where the exact ray meets nothing; not asked where the
//             surface is more curved than the place of the hit is known; along a needle, whose normal has no more digits,
//             the exact ray may meet it as well
//   leak      a ray passes through a fan of triangles that winds around it          (no allowance but at the outer rim)
//   lost      a box, voxel or cell that the exact ray touches is not visited        (no allowance at all)
//   border    a voxel is left at a t that is off by more than two roundings
// Each case is looked at with long double first; only what fails there is decided with 256 bits, and one case in 1024 is
// decided so anyhow: it must agree.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rayshade {

struct OracleReport {
  std::uint64_t cases = 0;
  std::uint64_t questions = 0;  // crossings that had to be found, points that had to be right
  std::uint64_t doubtful = 0;   // decided with 256 bits
  std::uint64_t failures = 0;
  double worst = 0;                   // distance of a hit from the surface                             [u M]
  std::vector<std::string> examples;  // the first failures, with all that is needed to repeat them
};

// Shapes by their names, then fan, slab, voxel, pyramid.
std::span<const std::string_view> oracleClasses();

OracleReport examine(std::string_view name, std::uint64_t seed, std::uint64_t first, std::uint64_t count);

}  // namespace rayshade
