// Affine maps, and chains of them that may change with time.
//
// Row vectors, as in rayshade: a point p goes to p M + t, and of two maps written one after the other the
// first is applied first.  An Affine carries its inverse, made from the inverses of its parts and never by
// elimination where a closed form exists.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "rayshade/base/archive.h"
#include "rayshade/base/bounds.h"
#include "rayshade/base/expression.h"
#include "rayshade/base/vec.h"

namespace rayshade {

struct Matrix {  // rows are the images of the axes
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Vec3 origin{0, 0, 0};  // the image of the origin
  friend bool operator==(const Matrix&, const Matrix&) = default;
};

inline Vec3 mapPoint(const Matrix& m, Vec3 p) { return m.x * p.x + m.y * p.y + m.z * p.z + m.origin; }
inline Vec3 mapVector(const Matrix& m, Vec3 v) { return m.x * v.x + m.y * v.y + m.z * v.z; }
// A normal goes with the transpose of the inverse: pass the inverse of the map.  Not normalised.
inline Vec3 mapNormal(const Matrix& inverse, Vec3 n) {
  return {dot(inverse.x, n), dot(inverse.y, n), dot(inverse.z, n)};
}

// The sizes of all elements, for bounds of errors.
inline Matrix absolute(const Matrix& m) {
  return {absolute(m.x), absolute(m.y), absolute(m.z), absolute(m.origin)};
}
Matrix product(const Matrix& first, const Matrix& second);

struct Affine {
  Matrix forward, inverse;
  friend bool operator==(const Affine&, const Affine&) = default;
};

inline bool isIdentity(const Affine& a) { return a == Affine{}; }
// Do both maps undo each other, nearly?  A product of good maps may have no inverse in doubles.
bool isInvertible(const Affine& a);

Affine then(const Affine& first, const Affine& second);
inline Affine inverted(const Affine& a) { return {a.inverse, a.forward}; }

Affine translation(Vec3 by);
std::optional<Affine> scaling(Vec3 by);                 // nothing when a factor is 0
Affine rotation(Vec3 axis, double degrees);             // right-handed; a zero axis turns nothing
std::optional<Affine> linearMap(const Matrix& matrix);  // `transform`; nothing when singular
Affine alongAxis(Vec3 base, Vec3 axis, double radius,
                 double height);  // canonical cylinder to its place, below

// The bounds of the image of a box; infinite sides give infinite bounds.
Bounds mapBounds(const Affine& a, const Bounds& bounds);

// One transform as written in a scene, with arguments that may depend on time.
struct MovingStep {
  enum class Kind : std::uint8_t { translate, scale, rotate, transform } kind = Kind::translate;
  std::vector<Expression> arguments;  // 3, 3, 4, 9 or 12
};

// Constant steps are multiplied together when they are written side by side.
struct TransformChain {
  std::vector<std::variant<Affine, MovingStep>> steps;

  bool empty() const { return steps.empty(); }
  bool moves() const;
  void append(const Affine& affine);
  void append(MovingStep step);
};

// The map of one step at a moment; nothing when it is singular then.
std::optional<Affine> stepAt(const MovingStep& step, const Moment& moment);
// The whole chain at a moment; nothing when a step is singular then.
std::optional<Affine> chainAt(const TransformChain& chain, const Moment& moment);

template <class Archive>
void serialize(Archive& archive, Matrix& m) {
  archive(m.x, m.y, m.z, m.origin);
}
template <class Archive>
void serialize(Archive& archive, Affine& a) {
  archive(a.forward, a.inverse);
}
template <class Archive>
void serialize(Archive& archive, MovingStep& s) {
  archive(s.kind, s.arguments);
  if constexpr (Archive::kReading) {
    const std::size_t n = s.arguments.size();
    const bool right = s.kind == MovingStep::Kind::translate || s.kind == MovingStep::Kind::scale ? n == 3
                       : s.kind == MovingStep::Kind::rotate                                       ? n == 4
                       : s.kind == MovingStep::Kind::transform ? n == 9 || n == 12
                                                               : false;
    if (!right) archive.fail();
  }
}
template <class Archive>
void serialize(Archive& archive, TransformChain& c) {
  archive(c.steps);
}

}  // namespace rayshade
