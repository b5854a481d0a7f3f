// What a shape is.
//
// A shape is plain data in its own (object) space plus a few pure functions; nothing in it is written after
// the scene was read, so asking twice, or asking another shape in between, changes nothing.  To add one: a
// file with the struct, its include and its name in all.h, an example in docs/language.md.  The compiler and the
// tests say what is missing.
//
//   keyword      the word of the language that makes one
//   aliases      other words for the same
//   flat         of two hits at the same t, one of a flat shape is taken, the first one defined
//   unbounded    at the same t, after flat ones, before all others, the first one defined
//   solid        encloses what is inside by itself (a plane: half of space), as an operand of CSG
//   examples     what may follow the keyword (after the optional surface).  Tests render them, change their numbers
//                at random, and ask of what comes out all that is said here
//   parse        reads the arguments; nothing when the shape is degenerate (the parser warns and drops it)
//   bounds       object space, not padded
//   intersect    the smallest t > tMin at which the ray meets the shape, or kNoHit; t along the unit direction
//                of the local ray.  All roots of one ray are the same numbers whatever tMin, so
//                intersect(ray, intersect(ray, t)) walks through them.  Exact tangency is a hit; a ray that
//                lies in a plane misses it.  No absolute epsilon.
//                With a third argument, tMax: what lies beyond it need not be found
//   pointAt      what is at t, a root that intersect returned for that ray
//   coordinates  u, v and the tangents at a point of the shape's space, for textures.  `at` is the hit;
//                `position` may differ from at.position (texture mapping may move it)
//   serialize    its fields, for the wire
//
// If it has them:
//
//   convex           true: it bounds a convex body, or part of it: a ray enters at the first of two roots, from minus infinity
//                    on, and leaves at the second; if it is solid a single root only touches
//   inside           of a point, if solid and unbounded: a ray need not cross such a shape to be inside of it
//   flipped          the same with its normals turned around, for option -f
//   beginsWithFile   true: the first argument is the name of a file, which the parser has to tell from that of a
//                    surface; it never takes what `applysurf` has set
//   SharesKeywordOf  a shape whose keyword this one has, too: the parser (parseShape) tells them apart
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <concepts>
#include <optional>
#include <span>
#include <string_view>

#include "rayshade/base/archive.h"
#include "rayshade/base/bounds.h"
#include "rayshade/optics/ray.h"
#include "rayshade/shapes/arguments.h"

namespace rayshade {

inline constexpr double kNoHit = kInfinity;

// A point of a surface, in the shape's space.
struct ShapePoint {
  Vec3 position;         // moved onto the surface as well as the shape can
  Vec3 normal;           // unit, for shading (interpolated on Phong triangles)
  Vec3 geometricNormal;  // unit, of the surface itself; outward on closed shapes, else as in the language
                         // reference
  Vec3 local;            // what coordinates() wants to know again: barycentrics, a face, ...
  double error = 0;      // the true surface is at most this far from `position`           [object units]
  double curvature =
      0;  // of the surface around it, at most; infinite: it may have edges       [1/object units]
};

struct SurfaceCoordinates {
  double u = 0, v = 0;
  Vec3 dpdu{1, 0, 0}, dpdv{0, 1, 0};  // unit, object space
};

// Relative rounding error of a few operations in a row (Higham's gamma), with room to spare.
inline constexpr double kRounding = 16 * 0x1p-53;

template <std::size_t N = 0>
using Aliases = std::array<std::string_view, N>;

template <class S>
concept Shape = Serializable<S> &&
    requires(const S shape, const LocalRay ray, double t, const ShapePoint at, Arguments& arguments) {
  { S::keyword } -> std::convertible_to<std::string_view>;
  { S::aliases } -> std::convertible_to<std::span<const std::string_view>>;
  { S::flat } -> std::convertible_to<bool>;
  { S::unbounded } -> std::convertible_to<bool>;
  { S::solid } -> std::convertible_to<bool>;
  { S::parse(arguments) } -> std::same_as<std::optional<S>>;
  { shape.bounds() } -> std::same_as<Bounds>;
  { shape.intersect(ray, t) } -> std::same_as<double>;
  { shape.pointAt(ray, t) } -> std::same_as<ShapePoint>;
  { shape.coordinates(at, at.position) } -> std::same_as<SurfaceCoordinates>;
  S::examples[0];
};

template <class S>
concept Convex = requires {
  requires S::convex;
};
template <class S>
concept BeginsWithFile = requires {
  requires S::beginsWithFile;
};

}  // namespace rayshade
