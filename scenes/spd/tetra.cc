// Tetra: Sierpinski's tetrahedron, `size` - 1 times divided: 4^size triangles.
//
// Source: Haines 1987; Glassner's thesis for the shape.
// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "scenes/spd/spd.h"

namespace rayshade::spd {

namespace {

using Tetrahedron = std::array<Vec3, 4>;

void divide(SceneWriter& out, MaterialId material, int times, const Tetrahedron& corners) {
  const auto& [a, b, c, d] = corners;
  if (times == 0) {
    out.triangle(material, {a, b, c});
    out.triangle(material, {d, c, b});
    out.triangle(material, {c, d, a});
    out.triangle(material, {b, a, d});
    return;
  }
  for (const Vec3& corner : corners) {
    divide(out, material, times - 1,
           {(corner + a) / 2, (corner + b) / 2, (corner + c) / 2, (corner + d) / 2});
  }
}

}  // namespace

void writeTetra(int size, SceneWriter& out) {
  out.view({.eye = {1.02285, -3.17715, -2.17451},
            .lookAt = {-0.004103, -0.004103, 0.216539},
            .up = {-0.816497, -0.816497, 0.816497}});
  out.light({2, -18, -5}, lightIntensity(1));
  const MaterialId red = out.material({.ambient = {0.1, 0.02, 0.02}, .diffuse = {1, 0.2, 0.2}});
  out.beginCrowd(power(4, size));
  divide(out, red, size - 1, {Vec3{-1, -1, 1}, Vec3{-1, 1, -1}, Vec3{1, -1, -1}, Vec3{1, 1, 1}});
  out.endCrowd();
}

}  // namespace rayshade::spd
