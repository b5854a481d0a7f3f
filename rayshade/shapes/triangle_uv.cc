// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shapes/triangle_uv.h"

namespace rayshade {

std::optional<TriangleUv> TriangleUv::parse(Arguments& in) {
  std::array<Vec3, 3> corners, normals;
  std::array<Uv, 3> uv;
  for (int i = 0; i < 3; ++i) {
    corners[i] = in.vector();
    normals[i] = in.vector();
    uv[i].u = in.number();
    uv[i].v = in.number();
    if (!std::isfinite(uv[i].u) || !std::isfinite(uv[i].v)) return std::nullopt;
  }
  const auto phong = PhongTriangle::checked({corners}, normals, in);
  if (!phong) return std::nullopt;
  return TriangleUv{*phong, uv};
}

SurfaceCoordinates TriangleUv::coordinates(const ShapePoint& at, Vec3 position) const {
  SurfaceCoordinates c = phong.coordinates(at, position);
  const Vec3 share = at.local;
  c.u = share.x * uv[0].u + share.y * uv[1].u + share.z * uv[2].u;
  c.v = share.x * uv[0].v + share.y * uv[1].v + share.z * uv[2].v;
  const double u2 = uv[1].u - uv[0].u, v2 = uv[1].v - uv[0].v;
  const double u3 = uv[2].u - uv[0].u, v3 = uv[2].v - uv[0].v;
  const double determinant = u2 * v3 - u3 * v2;
  if (determinant == 0 || !std::isfinite(determinant)) return c;  // no map: the tangents of a plain triangle
  const auto& corners = phong.face.corners;
  const Vec3 p2 = corners[1] - corners[0], p3 = corners[2] - corners[0];
  const double sign = std::copysign(1.0, determinant);
  c.dpdu = normalize(sign * (v3 * p2 - v2 * p3));
  c.dpdv = normalize(sign * (u2 * p3 - u3 * p2));
  return c;
}

}  // namespace rayshade
