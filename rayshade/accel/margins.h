// By how much the test of a ray against the boxes of a Bvh is widened, so that no box is missed.  These margins serve the test of
// single rays (bvh_ray.h) and that of bundles (bvh_bundle.h).
//
// Let the exact ray, in the tree's coordinates, be q + u d with |d|max in [1, 2) and u = t scale (exact: scale is a power of
// two), and let it touch a box at some u within [tMin, tMax] scale.
//
// 1. q' = fl(q) is off by at most 2^-53 |q|: centre and scale are exact numbers.  The root box widened by
//    slack = kSlack (1 + |q|) per side is entered, as computed with three roundings, before the root box
//    itself: one rounding is at most 2^-53 (|q| + |plane| + slack).  So start <= u.  A NaN (0 times infinity: a
//    direction of 0 exactly on the widened plane) is ignored by the comparisons, and the axis does not clip.
// 2. p = q' + start d is off by less than `slack` = kSlack (1 + |q| + |start d|).  near/farOrigin are p moved
//    forward/backward along the ray by twice the slack and kToFloat |p|; the roundings to float on the way, of p,
//    of the margin and of the sum, take less than 2^-23 |p| and a slack of it.  So the distance to each plane
//    of each box is too small for the near planes, too large for the far ones, before rounding.
// 3. (plane - origin) * inverse has three roundings to float, less than 2^-22 together.  nearInverse is
//    shortened, farInverse lengthened by kSlab, less one rounding.  A negative near becomes 0 by the comparison with 0; a
//    negative far keeps its sign, and is a true miss.  What underflows is far smaller than the slack.
// 4. |d| < kFlattest on an axis (0 and -0 among them) is replaced by kFlattest: within the root box s <= 2 + 4 slack,
//    the ray moves by less than the slack on that axis; a box that it touches has near < 0 and
//    far > (slack / 2) / kFlattest > s.  No factor is 0, none is infinite but the planes of unused children:
//    no NaN arises.
// 5. limit(tMax) = tMax scale - start has one rounding in double and one in float, widened by kToFloat.
//
// Hence enters <= s <= leaves for the box, and it is visited.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rayshade::margins {

// Of a coordinate in double, with a few roundings behind it: eight times the largest error of one.
inline constexpr double kSlack = 0x1p-50;
// Of a number that is rounded from double to float: four times the largest error.
inline constexpr double kToFloat = 0x1p-22;
// Of the distance to a plane, three operations in float: twice their errors.
inline constexpr float kSlab = 0x1p-21f;
// The least part of a direction along an axis, and its inverse.
inline constexpr double kFlattest = 0x1p-60, kSteepestInverse = 1 / kFlattest;

// Of a box's corner when it is rounded to float: larger than an error of a few 2^-53 |x| and half a float's last digit
// together; the constant serves where floats have fewer digits.
inline constexpr double kCorner = 0x1.8p-24, kCornerLeast = 0x1p-120;

// Where the tree's arithmetic cannot overflow: larger items count as unbounded, longer or shorter directions and farther
// origins see every item.
inline constexpr double kLargest = 0x1p+500, kSmallest = 0x1p-500;
inline constexpr double kFarthest = 0x1p+100;  // in the tree's coordinates: 2^100 times the size of the scene

}  // namespace rayshade::margins
