// Shells: spheres that overlap along a spiral on a cone, like a snail's shell; `size` turns with 640 spheres each.
//
// At angle a the radius is r = e^(0.15 a) and the centre (r sin a, r cos a, -2 r); the last sphere is at a = 6 pi.
// Source: Haines, Standard Procedural Databases, version 3; the spiral is the logarithmic one.
// SPDX-License-Identifier: BSD-3-Clause

#include "rayshade/base/elementary.h"
#include "scenes/spd/spd.h"

namespace rayshade::spd {

void writeShells(int size, SceneWriter& out) {
  constexpr int kPerTurn = 640, kLastTurn = 3;
  out.view({.eye = {-6, -60, 35}, .lookAt = {0, 8, -15}});
  out.light({-100, -100, 100}, lightIntensity(1));
  const MaterialId shell = out.material({.ambient = {0.1, 0.08, 0.04},
                                         .diffuse = {0.8, 0.64, 0.32},
                                         .specular = 0.2,
                                         .specularPower = 45.2776,
                                         .reflect = 1});
  const int last = kLastTurn * kPerTurn, first = last - size * kPerTurn;
  out.beginCrowd(static_cast<std::uint64_t>(last - first) + 1);
  for (int i = first; i <= last; ++i) {
    const double angle = 2 * elementary::acos(-1) * i / kPerTurn;
    const double radius = elementary::exp(0.15 * angle);
    out.sphere(shell, Vec3{elementary::sin(angle), elementary::cos(angle), -2} * radius, radius);
  }
  out.endCrowd();
}

}  // namespace rayshade::spd
