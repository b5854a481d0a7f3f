// The Phong triangle with texture coordinates of its own.
//
//   triangleuv  p1 n1 u1 v1  p2 n2 u2 v2  p3 n3 u3 v3                                          [object units]
//
// u and v are interpolated like the normals; the tangents solve
//   p2 - p1 = (u2 - u1) dpdu + (v2 - v1) dpdv,   p3 - p1 = (u3 - u1) dpdu + (v3 - v1) dpdv.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/shapes/triangle.h"

namespace rayshade {

struct TriangleUv {
  struct Uv {
    double u = 0, v = 0;
  };
  PhongTriangle phong;
  std::array<Uv, 3> uv{{{0, 0}, {1, 0}, {0, 1}}};

  static constexpr std::string_view keyword = "triangleuv";
  static constexpr Aliases<> aliases{};
  static constexpr bool flat = true, unbounded = false, solid = false;
  static constexpr std::string_view examples[] = {
      "0 0 0  0 0 1  0 0   1 0 0  1 0 1  1 0   0 1 0  0 1 1  0 1",
      "3 -4 5  0 1 0  0.5 0.5   1e3 0 0.5  -1 1 0  2 -1   2 2 -7  0 0 2  0.25 8"};

  static std::optional<TriangleUv> parse(Arguments& in);

  Bounds bounds() const { return phong.bounds(); }
  double intersect(const LocalRay& ray, double tMin) const { return phong.intersect(ray, tMin); }
  ShapePoint pointAt(const LocalRay& ray, double t) const { return phong.pointAt(ray, t); }
  SurfaceCoordinates coordinates(const ShapePoint& at, Vec3 position) const;
  TriangleUv flipped() const { return {phong.flipped(), uv}; }
};

template <class Archive>
void serialize(Archive& archive, TriangleUv::Uv& uv) {
  archive(uv.u, uv.v);
}
template <class Archive>
void serialize(Archive& archive, TriangleUv& t) {
  archive(t.phong, t.uv);
}

}  // namespace rayshade
