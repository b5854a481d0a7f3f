// Builds the tree of a Bvh, from the top down.
// Source: Wald 2007, On Fast Construction of SAH-based BVHs (bins).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>

#include "rayshade/accel/bvh_tree.h"

namespace rayshade {

// `items` in any space, at most so many; the caller has padded them.
inline constexpr std::size_t kMostItems = std::size_t{1} << kFirstBits;
BvhTree buildBvh(std::span<const Bounds> items);

// The same when the bounds are not lying anywhere: each is asked for twice, which is less than to keep them.  The tree is the
// same for any number of threads.
using BoundsOf = std::function<Bounds(std::uint32_t item)>;
BvhTree buildBvh(std::size_t items, const BoundsOf& boundsOf, unsigned threads = 1);

}  // namespace rayshade
