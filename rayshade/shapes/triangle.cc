// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shapes/triangle.h"

namespace rayshade {
namespace {

Vec3 scaledEdge(Vec3 from, Vec3 to, int exponent) {
  const Vec3 e = to - from;
  return {std::ldexp(e.x, -exponent), std::ldexp(e.y, -exponent), std::ldexp(e.z, -exponent)};
}

// Two edges of a triangle, scaled by a power of two so that their products are in range.
struct Edges {
  Vec3 first, second;

  explicit Edges(const std::array<Vec3, 3>& corners) {
    int exponent = 0;
    const double size = std::max(maxAbs(corners[1] - corners[0]), maxAbs(corners[2] - corners[0]));
    if (std::isfinite(size)) std::frexp(size, &exponent);
    first = scaledEdge(corners[0], corners[1], exponent);
    second = scaledEdge(corners[0], corners[2], exponent);
  }
};

}  // namespace

std::optional<Triangle> Triangle::parse(Arguments& in) {
  const Vec3 a = in.vector(), b = in.vector(), c = in.vector();
  const Triangle triangle{{a, b, c}};
  if (!triangle.hasArea()) return std::nullopt;
  return triangle;
}

bool Triangle::hasArea() const {
  for (const Vec3& corner : corners)
    if (!(maxAbs(corner) < 0x1p+500)) return false;
  const Bounds extent = bounds();
  if (!(maxAbs(extent.size()) > 0x1p-480)) return false;
  // differs from rayshade4: a triangle may be as small as you like; only what is flat up to rounding is not one.
  const Edges edges(corners);
  const double area = length(cross(edges.first, edges.second));
  return area > kRounding * length(edges.first) * length(edges.second);
}

Vec3 Triangle::normal() const {
  const Edges edges(corners);
  const Vec3 n = normalize(cross(edges.first, edges.second));
  return n == Vec3{} || !isFinite(n) ? Vec3{0, 0, 1} : n;
}

ShapePoint Triangle::pointAt(const LocalRay& ray, double) const {
  const EdgeTurns w = lookAlong(ray, [this](const auto& shear) {
    const ShearedPoint a = shear(corners[0]), b = shear(corners[1]), c = shear(corners[2]);
    return EdgeTurns(a, b, c).sharpened(a, b, c);
  });
  const double sum = w.sum();
  const Vec3 share{w.a / sum, w.b / sum, w.c / sum};
  const Vec3 position =
      corners[0] + share.y * (corners[1] - corners[0]) + share.z * (corners[2] - corners[0]);
  const double reach = std::max({maxAbs(corners[0]), maxAbs(corners[1]), maxAbs(corners[2])});
  const Vec3 n = normal();
  return {position, n, n, share, kRounding * reach};
}

SurfaceCoordinates Triangle::coordinates(const ShapePoint& at, Vec3 position) const {
  const Vec3 share = at.local;
  SurfaceCoordinates c;
  c.v = share.z;
  const double beside = share.x + share.y;
  c.u = beside > kRounding ? share.y / beside : 0;
  const Vec3 n = normal();
  const Vec3 edge = normalize(corners[1] - corners[0]);
  c.dpdu = n[dominantAxis(n)] < 0 ? -edge : edge;
  c.dpdv = normalize(corners[0] - position);
  if (c.dpdv == Vec3{}) c.dpdv = normalize(corners[0] - corners[2]);
  return c;
}

std::optional<PhongTriangle> PhongTriangle::checked(Triangle face, const std::array<Vec3, 3>& normals,
                                                    Arguments& in) {
  for (const Vec3& n : normals)
    if (!isFinite(n)) return std::nullopt;
  if (!face.hasArea()) return std::nullopt;
  if (dot(face.normal(), normals[0]) < 0) in.warn("the corners run clockwise seen from the first normal");
  return PhongTriangle{face, {normalize(normals[0]), normalize(normals[1]), normalize(normals[2])}};
}

std::optional<PhongTriangle> PhongTriangle::parse(Arguments& in) {
  std::array<Vec3, 3> corners, normals;
  for (int i = 0; i < 3; ++i) {
    corners[i] = in.vector();
    normals[i] = in.vector();
  }
  return checked({corners}, normals, in);
}

ShapePoint PhongTriangle::pointAt(const LocalRay& ray, double t) const {
  ShapePoint at = face.pointAt(ray, t);
  if (dot(at.geometricNormal, normals[0]) < 0) at.geometricNormal = -at.geometricNormal;
  const Vec3 share = at.local;
  at.normal = normalize(share.x * normals[0] + share.y * normals[1] + share.z * normals[2]);
  if (at.normal == Vec3{} || !isFinite(at.normal)) at.normal = at.geometricNormal;
  return at;
}

std::optional<std::variant<Triangle, PhongTriangle>> parseTriangle(Arguments& in) {
  std::array<Vec3, 6> given;
  for (int i = 0; i < 3; ++i) given[i] = in.vector();
  if (!in.numberFollows()) {
    const Triangle flat{{given[0], given[1], given[2]}};
    if (!flat.hasArea()) return std::nullopt;
    return flat;
  }
  for (int i = 3; i < 6; ++i) given[i] = in.vector();
  const auto phong =
      PhongTriangle::checked({{given[0], given[2], given[4]}}, {given[1], given[3], given[5]}, in);
  if (!phong) return std::nullopt;
  return *phong;
}

}  // namespace rayshade
