// Balls, or sphereflake: a sphere that carries nine spheres of a third of its radius, each of which carries nine,
// and so on; `size` generations below the first.
//
// The nine touch their parent where twelve equal spheres would touch it in a close packing, without the three
// below: six around the equator, three above, seen with the direction away from the grandparent upwards.
// Spheres: (9^(size+1) - 1) / 8.
// Source: Haines 1987; the directions are the corners of a cuboctahedron.
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>

#include "rayshade/base/elementary.h"
#include "scenes/spd/spd.h"

namespace rayshade::spd {

namespace {

constexpr int kChildren = 9;
constexpr double kShrink = 1.0 / 3;

using Directions = std::array<Vec3, kChildren>;

Directions childDirections() {
  // The first of the upper three points to azimuth 45 degrees; its neighbours on the equator are 30 degrees off.
  Directions result;
  const double height = std::sqrt(2.0 / 3), across = std::sqrt(1.0 / 3);
  const double angle15 = elementary::acos(-1) / 12;
  for (int third = 0; third < 3; ++third) {
    const double upper = angle15 * (3 + 8 * third);
    result[3 * third] = {across * elementary::cos(upper), across * elementary::sin(upper), height};
    for (int side = 0; side < 2; ++side) {
      const double equator = angle15 * (1 + 4 * side + 8 * third);
      result[3 * third + 1 + side] = {elementary::cos(equator), elementary::sin(equator), 0};
    }
  }
  return result;
}

// Turns v as the shortest rotation turns +z into `up` (unit length).
Vec3 stood(Vec3 v, Vec3 up) {
  // Straight down, but for rounding: any axis would be as short; the y axis it is.
  if (1 + up.z < 1e-12) return {-v.x, v.y, -v.z};
  const Vec3 axis{-up.y, up.x, 0};  // z cross up: as long as the sine of the angle
  // Rodrigues' formula; (1 - cos) / sin^2 = 1 / (1 + cos)
  return v * up.z + cross(axis, v) + axis * (dot(axis, v) / (1 + up.z));
}

void ball(SceneWriter& out, MaterialId material, const Directions& directions, int generations, Vec3 centre,
          double radius, Vec3 up) {
  out.sphere(material, centre, radius);
  if (generations == 0) return;
  for (const Vec3& local : directions) {
    const Vec3 direction = stood(local, up);
    ball(out, material, directions, generations - 1, centre + direction * (radius * (1 + kShrink)),
         radius * kShrink, direction);
  }
}

}  // namespace

void writeBalls(int size, SceneWriter& out) {
  out.view({.eye = {2.1, 1.3, 1.7}, .lookAt = {}});
  for (const Vec3 position : {Vec3{4, 3, 2}, Vec3{1, -4, 4}, Vec3{-3, 1, 5}}) {
    out.light(position, lightIntensity(3));
  }
  const MaterialId floor = out.material({.ambient = {0.1, 0.075, 0.033}, .diffuse = {0.8, 0.6, 0.264}});
  const MaterialId ivory = out.material({.ambient = {0.1, 0.09, 0.07},
                                         .diffuse = {0.5, 0.45, 0.35},
                                         .specular = 0.5,
                                         .specularPower = 3.0827,
                                         .reflect = 1});
  out.polygon(floor,
              std::array{Vec3{12, 12, -0.5}, Vec3{-12, 12, -0.5}, Vec3{-12, -12, -0.5}, Vec3{12, -12, -0.5}});
  out.beginCrowd((power(9, size + 1) - 1) / 8);
  ball(out, ivory, childDirections(), size, {}, 0.5, {0, 0, 1});
  out.endCrowd();
}

}  // namespace rayshade::spd
