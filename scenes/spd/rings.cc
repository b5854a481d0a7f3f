// Rings: a pyramid of clusters; each cluster is six interlocked pentagonal rings of balls and rods around one
// centre, in planes across the six axes of an icosahedron.
//
// Layer k = 1 ... size has k^2 clusters, two units apart, 2.613 units behind the layer before: just what a view
// of 45 degrees widens by.  Spheres, and as many cylinders: 30 * size (size + 1) (2 size + 1) / 6.
// Source: Haines 1987; the two radii are those of the original scene.
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>

#include "rayshade/base/elementary.h"
#include "scenes/spd/spd.h"

namespace rayshade::spd {

namespace {

constexpr int kRings = 6, kSides = 5;
constexpr double kRingRadius = 0.930995, kTubeRadius = 0.07412;

using Ring = std::array<Vec3, kSides>;

std::array<Ring, kRings> cluster() {
  std::array<Ring, kRings> result;
  const double fifth = 2 * elementary::acos(-1) / kSides;
  const double cosTilt = std::sqrt(0.2), sinTilt = std::sqrt(0.8);  // between two axes of an icosahedron
  for (int ring = 0; ring < kRings; ++ring) {
    // All six pass through the plane z = 0: the first lies in it, the others start there, 36 + 72 k degrees round.
    const double start = ring == 0 ? 0 : fifth * (ring - 0.5);
    const Vec3 first{elementary::cos(start), elementary::sin(start), 0};
    const Vec3 across{-elementary::sin(start), elementary::cos(start), 0};
    const Vec3 second = ring == 0 ? across : across * cosTilt + Vec3{0, 0, sinTilt};
    for (int side = 0; side < kSides; ++side) {
      result[ring][side] =
          (first * elementary::cos(fifth * side) + second * elementary::sin(fifth * side)) * kRingRadius;
    }
  }
  return result;
}

}  // namespace

void writeRings(int size, SceneWriter& out) {
  const double halfView = elementary::acos(-1) / 8;
  const double depth = 1 / elementary::sin(halfView);
  const Vec3 eye{-1, -depth, 0.5};
  out.view({.eye = eye, .lookAt = eye + Vec3{0, 1, 0}});
  for (const Vec3 offset : {Vec3{4, 0, 2.5}, Vec3{-3, 0, 0.5}, Vec3{3, 0, -4.5}}) {
    out.light(eye + offset, lightIntensity(3));
  }
  const MaterialId wall = out.material({.ambient = {0.1, 0.1, 0.1}, .diffuse = {1, 1, 1}});
  constexpr Color kColors[kRings] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}};
  MaterialId materials[kRings];
  for (int ring = 0; ring < kRings; ++ring) {
    materials[ring] = out.material({.ambient = kColors[ring] * 0.1,
                                    .diffuse = kColors[ring] * 0.5,
                                    .specular = 0.2,
                                    .specularPower = 3.0827,
                                    .reflect = 1});
  }
  // The wall behind fills the view with one percent to spare.
  const double back = (size + 1) * depth, half = (back - eye.y) * elementary::tan(halfView) * 1.01;
  out.polygon(wall,
              std::array{Vec3{eye.x + half, back, eye.z + half}, Vec3{eye.x - half, back, eye.z + half},
                         Vec3{eye.x - half, back, eye.z - half}, Vec3{eye.x + half, back, eye.z - half}});

  const std::array<Ring, kRings> rings = cluster();
  const std::uint64_t n = size;
  out.beginCrowd(2 * kRings * kSides * (n * (n + 1) * (2 * n + 1) / 6));
  for (int layer = 1; layer <= size; ++layer) {
    for (int z = 0; z < layer; ++z) {
      for (int x = 0; x < layer; ++x) {
        const Vec3 centre{2.0 * x - (layer - 1), layer * depth, 2.0 * z - (layer - 1)};
        for (int ring = 0; ring < kRings; ++ring) {
          for (int side = 0; side < kSides; ++side) {
            const Vec3 corner = centre + rings[ring][side];
            const Vec3 previous = centre + rings[ring][(side + kSides - 1) % kSides];
            out.cylinder(materials[ring], kTubeRadius, corner, previous);
            out.sphere(materials[ring], corner, kTubeRadius);
          }
        }
      }
    }
  }
  out.endCrowd();
}

}  // namespace rayshade::spd
