// Points, directions and normals: three doubles.
//
// One type serves all three, as in the formulas of the books; which space a vector lives in (world, object)
// is said where it is declared.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace rayshade {

struct Vec3 {
  double x = 0, y = 0, z = 0;

  constexpr double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr double& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(Vec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
constexpr Vec3 operator*(double s, Vec3 a) { return a * s; }
constexpr Vec3 operator/(Vec3 a, double s) { return {a.x / s, a.y / s, a.z / s}; }

constexpr double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline Vec3 absolute(Vec3 a) { return {std::abs(a.x), std::abs(a.y), std::abs(a.z)}; }
inline double maxAbs(Vec3 a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }

// The length of a vector whose square does not fit: scaled by a power of two first.
[[gnu::noinline]] inline double lengthOfExtreme(Vec3 a) {
  const double largest = maxAbs(a);
  if (!(largest > 0) || !std::isfinite(largest)) return largest;
  int exponent;
  std::frexp(largest, &exponent);
  const Vec3 scaled{std::ldexp(a.x, -exponent), std::ldexp(a.y, -exponent), std::ldexp(a.z, -exponent)};
  return std::ldexp(std::sqrt(dot(scaled, scaled)), exponent);
}

// Length without overflow or underflow on the way.
inline double length(Vec3 a) {
  const double squared = dot(a, a);
  return squared > 1e-280 && squared < 1e280 ? std::sqrt(squared) : lengthOfExtreme(a);
}

// A vector of length 1; the zero vector stays zero.
inline Vec3 normalize(Vec3 a) {
  double l = length(a);
  if (!(l > 0)) return a;
  if (l < 1e-300) [[unlikely]] {  // 1/l would overflow
    a = a * 0x1p+600;
    l = length(a);
  }
  return a / l;
}

inline bool isFinite(Vec3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

// The axis (0, 1, 2) of the largest component.
inline int dominantAxis(Vec3 a) {
  const double x = std::abs(a.x), y = std::abs(a.y), z = std::abs(a.z);
  return x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
}

// Two unit vectors that complete the unit vector `w` to a right-angled frame; the first lies in the xy plane
// unless w is the z axis (the convention of rayshade's extended light and gloss texture).
struct Basis {
  Vec3 first, second;
};
inline Basis basisAround(Vec3 w) {
  Vec3 first{-w.y, w.x, 0};
  if (first.x == 0 && first.y == 0) first = {w.z, 0, -w.x};
  first = normalize(first);
  return {first, normalize(cross(w, first))};
}

template <class Archive>
void serialize(Archive& archive, Vec3& v) {
  archive(v.x, v.y, v.z);
}

}  // namespace rayshade
