// Tree: a trunk that forks into two boughs `size` times; each bough is a cone with a sphere at its end.
//
// Cones, and as many spheres: 2^(size+1) - 1.
// Source: Aono & Kunii, Botanical Tree Image Generation, IEEE CG&A 4(5), 1984 (angles, lengths of a fork).
// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "rayshade/base/elementary.h"
#include "scenes/spd/spd.h"

namespace rayshade::spd {

namespace {

struct Bough {
  double tilt;     // from the parent's direction [degrees]
  double azimuth;  // around it, from the parent's first axis [degrees]
  double length;   // of the parent's
};
constexpr Bough kFork[] = {{40, 0, 0.65}, {25, 140, 0.7}};
constexpr double kThinning = 0.67;  // radius at the end over radius at the start

struct Frame {
  Vec3 x, y, z;  // z along the bough
};

// The frame of a bough; its own fork is turned by a right angle.
Frame forked(const Frame& parent, const Bough& bough) {
  const double degree = elementary::acos(-1) / 180;
  const double c = elementary::cos(bough.azimuth * degree), s = elementary::sin(bough.azimuth * degree);
  const Vec3 outward = parent.x * c + parent.y * s, sideways = parent.y * c - parent.x * s;
  const double cosTilt = elementary::cos(bough.tilt * degree), sinTilt = elementary::sin(bough.tilt * degree);
  return {sideways, parent.z * sinTilt - outward * cosTilt, parent.z * cosTilt + outward * sinTilt};
}

void grow(SceneWriter& out, MaterialId bark, int forks, const Frame& frame, Vec3 base, double length,
          double radius) {
  const Vec3 end = base + frame.z * length;
  const double endRadius = radius * kThinning;
  out.cone(bark, radius, base, endRadius, end);
  out.sphere(bark, end, endRadius);
  if (forks == 0) return;
  for (const Bough& bough : kFork) {
    grow(out, bark, forks - 1, forked(frame, bough), end, length * bough.length, endRadius);
  }
}

}  // namespace

void writeTree(int size, SceneWriter& out) {
  out.view({.eye = {4.5, 0.4, 2}, .lookAt = {0, 0, 1.5}});
  for (const Vec3 position : {Vec3{-5, 5, 50}, Vec3{30, -30, 30}, Vec3{-40, -30, 20}, Vec3{10, 30, 40},
                              Vec3{-30, 40, 10}, Vec3{50, 25, 20}, Vec3{-10, -60, 30}}) {
    out.light(position, lightIntensity(7));
  }
  const MaterialId grass = out.material({.ambient = {0.02, 0.07, 0.02}, .diffuse = {0.2, 0.7, 0.2}});
  const MaterialId bark = out.material({.ambient = {0.055, 0.04, 0.02}, .diffuse = {0.55, 0.4, 0.2}});
  out.polygon(grass, std::array{Vec3{50, 50, 0}, Vec3{-50, 50, 0}, Vec3{-50, -50, 0}, Vec3{50, -50, 0}});
  out.beginCrowd(2 * (power(2, size + 1) - 1));
  grow(out, bark, size, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}, 1, 0.15);
  out.endCrowd();
}

}  // namespace rayshade::spd
