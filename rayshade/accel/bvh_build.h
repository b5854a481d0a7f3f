// Builds the tree of a Bvh, from the top down.
// Source: Wald 2007, On Fast Construction of SAH-based BVHs (bins).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "rayshade/accel/bvh_tree.h"

namespace rayshade {

// `items` in any space, at most so many; the caller has padded them.
inline constexpr std::size_t kMostItems = std::size_t{1} << kFirstBits;
BvhTree buildBvh(std::span<const Bounds> items);

}  // namespace rayshade
