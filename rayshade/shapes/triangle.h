// Triangles, flat and with interpolated normals.
//
//   triangle  p1 p2 p3                   flat                                                  [object units]
//   triangle  p1 n1  p2 n2  p3 n3        Phong: the shading normal goes from corner to corner
//
// The ray is inside when it passes all three edges on the same side, or meets one (shear.h); the turns around
// the edges are the weights of the corners opposite to them, and t is the mean of their depths.  A closed mesh
// has no leaks: an edge or a corner that is met exactly is a hit of every triangle there, at the same t.
//
// The two are types of their own so that the many flat triangles of a mesh take 72 bytes each.
// Default coordinates: v = b3, u = b2 / (b1 + b2) with weights b.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <variant>

#include "rayshade/shapes/shape.h"
#include "rayshade/shapes/shear.h"

namespace rayshade {

// How the edges turn around a ray; each is the weight of the corner opposite to it, not yet normalised.
struct EdgeTurns {
  double a, b, c;

  EdgeTurns(const ShearedPoint& pa, const ShearedPoint& pb, const ShearedPoint& pc)
      : a(turn(pb, pc)), b(turn(pc, pa)), c(turn(pa, pb)) {}
  double sum() const { return a + b + c; }
  // All on one side, or met.  The signs are hard to predict, so they are joined without branches.
  bool inside() const {
    const int negative = (a < 0) | (b < 0) | (c < 0), positive = (a > 0) | (b > 0) | (c > 0);
    return (negative & positive) == 0;
  }
  bool edgeMet() const { return (a == 0) + (b == 0) + (c == 0) == 1; }  // and no corner

  // As weights: of a needle, or a face seen edge on, rounding would leave little but its own.
  EdgeTurns sharpened(const ShearedPoint& pa, const ShearedPoint& pb, const ShearedPoint& pc) const {
    const double width = std::max({std::abs(pa.x), std::abs(pb.x), std::abs(pc.x)});
    const double height = std::max({std::abs(pa.y), std::abs(pb.y), std::abs(pc.y)});
    constexpr double kClear = 0x1p-3;  // no more than three bits are lost
    if (std::abs(sum()) > kClear * width * height) [[likely]]
      return *this;
    EdgeTurns sharp = *this;
    sharp.a = turnToTheLastDigit(pb, pc);
    sharp.b = turnToTheLastDigit(pc, pa);
    sharp.c = turnToTheLastDigit(pa, pb);
    return sharp;
  }
};

// t where the ray meets the edge from a to b.  The same bits for either direction of the edge, so that the
// triangles on both sides of it give the same t.
inline double depthOnEdge(const ShearedPoint& a, const ShearedPoint& b) {
  const double x = b.x - a.x, y = b.y - a.y;
  return std::abs(x) > std::abs(y) ? (a.depth * b.x - b.depth * a.x) / x
                                   : (a.depth * b.y - b.depth * a.y) / y;
}

struct Triangle {
  std::array<Vec3, 3> corners{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};

  static constexpr std::string_view keyword = "triangle";
  static constexpr Aliases<> aliases{};
  static constexpr bool flat = true, unbounded = false, solid = false;
  static constexpr std::string_view examples[] = {"0 0 0  1 0 0  0 1 0", "3 -4 5  1e3 0 0.5  2 2 -7"};

  static std::optional<Triangle> parse(Arguments& in);  // flat

  Bounds bounds() const { return join(join(Bounds{corners[0], corners[0]}, corners[1]), corners[2]); }
  double intersect(const LocalRay& ray, double tMin) const;
  ShapePoint pointAt(const LocalRay& ray, double t) const;  // local: the weights of the corners
  SurfaceCoordinates coordinates(const ShapePoint& at, Vec3 position) const;

  Vec3 normal() const;   // unit; the side from which the corners run counter-clockwise
  bool hasArea() const;  // else it is a line or a point, up to rounding, or too large or small for doubles
  Triangle flipped() const { return {{corners[1], corners[0], corners[2]}}; }  // for option -f; u mirrors
};
static_assert(sizeof(Triangle) == 72);

inline double Triangle::intersect(const LocalRay& ray, double tMin) const {
  return lookAlong(ray, [this, tMin](const auto& shear) {
    const ShearedPoint a = shear(corners[0]), b = shear(corners[1]), c = shear(corners[2]);
    const EdgeTurns turns(a, b, c);
    if (!turns.inside() || turns.sum() == 0) return kNoHit;  // a zero sum: the ray lies in the plane
    const EdgeTurns w = turns.sharpened(a, b, c);
    const double sum = w.sum();
    double t;
    if (w.edgeMet()) [[unlikely]] {
      t = w.a == 0 ? depthOnEdge(b, c) : w.b == 0 ? depthOnEdge(c, a) : depthOnEdge(a, b);
    } else {
      t = w.a / sum * a.depth + w.b / sum * b.depth + w.c / sum * c.depth;
    }
    return t > tMin ? t : kNoHit;
  });
}

struct PhongTriangle {
  Triangle face;
  std::array<Vec3, 3> normals{{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}};  // at the corners, of any length

  using SharesKeywordOf = Triangle;
  static constexpr std::string_view keyword = Triangle::keyword;
  static constexpr Aliases<> aliases{};
  static constexpr bool flat = true, unbounded = false, solid = false;
  static constexpr std::string_view examples[] = {"0 0 0  0 0 1  1 0 0  1 0 1  0 1 0  0 1 1",
                                                  "3 -4 5  0 1 0  1e3 0 0.5  -1 1 0  2 2 -7  0 0 2"};

  static std::optional<PhongTriangle> parse(Arguments& in);
  // Warns when the corners run the other way than the normals say; the normals win.
  static std::optional<PhongTriangle> checked(Triangle face, const std::array<Vec3, 3>& normals,
                                              Arguments& in);

  Bounds bounds() const { return face.bounds(); }
  double intersect(const LocalRay& ray, double tMin) const { return face.intersect(ray, tMin); }
  ShapePoint pointAt(const LocalRay& ray, double t) const;
  SurfaceCoordinates coordinates(const ShapePoint& at, Vec3 position) const {
    return face.coordinates(at, position);
  }
  PhongTriangle flipped() const { return {face, {-normals[0], -normals[1], -normals[2]}}; }
};

// What follows the word `triangle`: 9 or 18 numbers tell which of the two it is.
std::optional<std::variant<Triangle, PhongTriangle>> parseTriangle(Arguments& in);

template <class Archive>
void serialize(Archive& archive, Triangle& t) {
  archive(t.corners);
}
template <class Archive>
void serialize(Archive& archive, PhongTriangle& t) {
  archive(t.face, t.normals);
}

}  // namespace rayshade
