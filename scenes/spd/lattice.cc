// Lattice: (size + 1)^3 shiny balls in the unit cube, joined by red, green and blue rods along x, y and z.
//
// Cylinders: 3 size (size + 1)^2.  The eye is inside, in the middle of a cell.
// Source: Haines 1987; measures in units of a cell: ball 1/4, rod 1/16, the rod's ends inside the balls.
// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/spd/spd.h"

namespace rayshade::spd {

namespace {
constexpr double kBall = 0.25, kRod = 0.0625, kRodStart = 0.12375;  // [cells]
}  // namespace

void writeLattice(int size, SceneWriter& out) {
  const double cell = 1.0 / size;
  const double middle = (size / 2 + 0.5) * cell, last = (size - 0.5) * cell;
  out.view(
      {.eye = {middle, 1, last}, .lookAt = {middle, -1, last - 2}, .up = {0.2, 1, 0}, .fieldOfView = 60});
  for (const Vec3 position : {Vec3{2, 0.5, 0.5}, Vec3{-1, 0.5, 0.5}, Vec3{0.5, 2, 0.5}, Vec3{0.5, -1, 0.5},
                              Vec3{0.5, 0.5, 2}, Vec3{0.5, 0.5, -1}}) {
    out.light(position, lightIntensity(6));
  }
  const MaterialId steel = out.material({.ambient = {0.09, 0.09, 0.09},
                                         .diffuse = {0.45, 0.45, 0.45},
                                         .specular = 0.5,
                                         .specularPower = 3.0827,
                                         .reflect = 1});
  MaterialId rods[3];
  for (int axis = 0; axis < 3; ++axis) {
    const auto channel = [axis](int i, double on, double off) { return i == axis ? on : off; };
    rods[axis] = out.material(
        {.ambient = {channel(0, 0.09, 0.01), channel(1, 0.09, 0.01), channel(2, 0.09, 0.01)},
         .diffuse = {channel(0, 0.891, 0.099), channel(1, 0.891, 0.099), channel(2, 0.891, 0.099)}});
  }

  const std::uint64_t n = size;
  out.beginCrowd((n + 1) * (n + 1) * (n + 1) + 3 * n * (n + 1) * (n + 1));
  for (int x = 0; x <= size; ++x) {
    for (int y = 0; y <= size; ++y) {
      for (int z = 0; z <= size; ++z) {
        const int at[3] = {x, y, z};
        const Vec3 centre = Vec3{double(x), double(y), double(z)} * cell;
        out.sphere(steel, centre, kBall * cell);
        for (int axis = 0; axis < 3; ++axis) {
          if (at[axis] == size) continue;
          Vec3 along;
          along[axis] = cell;
          out.cylinder(rods[axis], kRod * cell, centre + along * kRodStart, centre + along * (1 - kRodStart));
        }
      }
    }
  }
  out.endCrowd();
}

}  // namespace rayshade::spd
