// Teapot: Newell's teapot, 32 bicubic patches, each cut into size^2 squares of two smooth triangles, on a chequered
// floor of size^2 squares.
//
// Round parts (rim, body, lid, bottom) are given by their profile and swept around by quarter circles in Bezier
// form, with Newell's 0.56 for the length of the handles; handle and spout by the curves where they cross the plane
// of symmetry.  Where a side shrinks to a point (top of the lid, middle of the bottom) a square gives one triangle:
// 64 size^2 - 8 size triangles.
// Source: M. Newell, The Utilization of Procedure Models in Digital Image Synthesis, thesis, Utah 1975 (the data,
// also in Blinn, What, Teapots Again?, IEEE CG&A 7(9), 1987).
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "scenes/spd/spd.h"

namespace rayshade::spd {

namespace {

using Patch = std::array<std::array<Vec3, 4>, 4>;  // [v][u]

struct Turned {
  struct {
    double radius, height;
  } profile[4];
  double handle[4];  // of the quarter circles
  bool backwards;    // clockwise, seen from above: the profile runs inside out
};
constexpr double kArc = 0.56;
constexpr Turned kTurned[] = {
    {{{1.4, 2.4}, {1.3375, 2.53125}, {1.4375, 2.53125}, {1.5, 2.4}}, {kArc, kArc, kArc, kArc}, true},  // rim
    {{{1.5, 2.4}, {1.75, 1.875}, {2, 1.35}, {2, 0.9}}, {kArc, kArc, kArc, kArc}, true},                // body
    {{{2, 0.9}, {2, 0.45}, {1.5, 0.225}, {1.5, 0.15}}, {kArc, kArc, kArc, kArc}, true},
    {{{0, 3.15}, {0.8, 3.15}, {0, 2.85}, {0.2, 2.7}},
     {kArc, 0.5625, kArc, kArc},
     true},  // lid; 0.45 for 0.448
    {{{0.2, 2.7}, {0.4, 2.55}, {1.3, 2.55}, {1.3, 2.4}}, {kArc, kArc, kArc, kArc}, true},
    {{{0, 0}, {1.425, 0}, {1.5, 0.075}, {1.5, 0.15}}, {kArc, kArc, kArc, kArc}, false},  // bottom
};

// A curve in the plane y = 0, another one there, and how far the two curves between them stand off that plane.
struct Mirrored {
  struct Point {
    double x, z;
  } first[4], second[4];
  double across[4];
};
constexpr Mirrored kMirrored[] = {
    {{{-1.6, 2.025}, {-2.3, 2.025}, {-2.7, 2.025}, {-2.7, 1.8}},  // handle, upper part
     {{-1.5, 2.25}, {-2.5, 2.25}, {-3, 2.25}, {-3, 1.8}},
     {0.3, 0.3, 0.3, 0.3}},
    {{{-2.7, 1.8}, {-2.7, 1.575}, {-2.5, 1.125}, {-2, 0.9}},
     {{-3, 1.8}, {-3, 1.35}, {-2.65, 0.9375}, {-1.9, 0.6}},
     {0.3, 0.3, 0.3, 0.3}},
    {{{1.7, 1.425}, {2.6, 1.425}, {2.3, 2.1}, {2.7, 2.4}},  // spout, lower part
     {{1.7, 0.6}, {3.1, 0.825}, {2.4, 2.025}, {3.3, 2.4}},
     {0.66, 0.66, 0.25, 0.25}},
    {{{2.7, 2.4}, {2.8, 2.475}, {2.9, 2.475}, {2.8, 2.4}},
     {{3.3, 2.4}, {3.525, 2.49375}, {3.45, 2.5125}, {3.2, 2.4}},
     {0.25, 0.25, 0.15, 0.15}},
};

Patch quarterOf(const Turned& part, int quarter) {
  constexpr double kCos[] = {1, 0, -1, 0}, kSin[] = {0, 1, 0, -1};
  const int start = part.backwards ? (4 - quarter) % 4 : quarter,
            end = (start + (part.backwards ? 3 : 1)) % 4;
  const Vec3 from{kCos[start], kSin[start], 0}, to{kCos[end], kSin[end], 0};
  Patch patch;
  for (int v = 0; v < 4; ++v) {
    const auto [radius, height] = part.profile[v];
    const Vec3 centre{0, 0, height};
    const double handle = part.handle[v];
    patch[v] = {centre + from * radius, centre + (from + to * handle) * radius,
                centre + (from * handle + to) * radius, centre + to * radius};
  }
  return patch;
}

Patch halfOf(const Mirrored& part, double side) {
  Patch patch;
  for (int v = 0; v < 4; ++v) {
    const Vec3 a{part.first[v].x, 0, part.first[v].z}, b{part.second[v].x, 0, part.second[v].z};
    const Vec3 off{0, side * part.across[v], 0};
    patch[v] = {a, a + off, b + off, b};
    if (side > 0) patch[v] = {b, b + off, a + off, a};  // so that both halves turn the same way
  }
  return patch;
}

std::vector<Patch> teapot() {
  std::vector<Patch> patches;
  for (const Turned& part : kTurned) {
    for (int quarter = 0; quarter < 4; ++quarter) patches.push_back(quarterOf(part, quarter));
  }
  for (const Mirrored& part : kMirrored) {
    for (const double side : {-1.0, 1.0}) patches.push_back(halfOf(part, side));
  }
  return patches;
}

// Bernstein polynomials of degree 3 and their derivatives.
using Weights = std::array<double, 4>;
Weights bernstein(double t) {
  const double s = 1 - t;
  return {s * s * s, 3 * t * s * s, 3 * t * t * s, t * t * t};
}
Weights bernsteinSlope(double t) {
  const double s = 1 - t;
  return {-3 * s * s, 3 * s * s - 6 * t * s, 6 * t * s - 3 * t * t, 3 * t * t};
}

Vec3 blend(const Patch& patch, const Weights& along, const Weights& across) {
  Vec3 sum;
  for (int v = 0; v < 4; ++v) {
    for (int u = 0; u < 4; ++u) sum = sum + patch[v][u] * (along[u] * across[v]);
  }
  return sum;
}

struct Vertex {
  Vec3 position, normal;
};

Vertex evaluate(const Patch& patch, double u, double v) {
  const Weights along = bernstein(u), across = bernstein(v), slopeU = bernsteinSlope(u),
                slopeV = bernsteinSlope(v);
  Vec3 tangentU = blend(patch, slopeU, across);
  // At a pole the side has no length; how it begins to grow has the direction.
  if (patch[0][0] == patch[0][3] && v == 0) tangentU = blend(patch, slopeU, slopeV);
  return {blend(patch, along, across), normalize(cross(tangentU, blend(patch, along, slopeV)))};
}

void writePatch(SceneWriter& out, MaterialId material, int size, const Patch& patch) {
  const double step = 1.0 / size;
  std::vector<Vertex> row(size + 1), next(size + 1);
  for (int v = 0; v <= size; ++v) {
    std::swap(row, next);
    for (int u = 0; u <= size; ++u) next[u] = evaluate(patch, u * step, v * step);
    if (v == 0) continue;
    const bool pole = v == 1 && patch[0][0] == patch[0][3];
    for (int u = 0; u < size; ++u) {
      const Vertex &a = row[u], &b = row[u + 1], &c = next[u + 1], &d = next[u];
      if (!pole) {
        out.smoothTriangle(material, {a.position, b.position, c.position}, {a.normal, b.normal, c.normal});
      }
      out.smoothTriangle(material, {c.position, d.position, a.position}, {c.normal, d.normal, a.normal});
    }
  }
}

}  // namespace

void writeTeapot(int size, SceneWriter& out) {
  out.view({.eye = {4.86, 7.2, 5.4}, .lookAt = {}});
  for (const Vec3 position : {Vec3{-3.1, 9.8, 12.1}, Vec3{11.3, 5.1, 8.8}}) {
    out.light(position, lightIntensity(2));
  }
  const auto tile = [&out](double grey) {
    return out.material({.ambient = Color{grey, grey, grey} * 0.2,
                         .diffuse = {grey, grey, grey},
                         .specular = 0.5,
                         .specularPower = 4.81884,
                         .reflect = 1});
  };
  const MaterialId light = tile(0.5), dark = tile(0.25);
  const MaterialId glaze = out.material({.ambient = {0.1, 0.05, 0.01},
                                         .diffuse = {0.75, 0.375, 0.075},
                                         .specular = 0.25,
                                         .specularPower = 3.0827,
                                         .reflect = 1});
  const std::uint64_t n = size;
  out.beginCrowd(65 * n * n - 8 * n);
  const double edge = 8.0 / size;
  for (int x = 0; x < size; ++x) {
    for (int y = 0; y < size; ++y) {
      const double left = -4 + x * edge, right = -4 + (x + 1) * edge;
      const double front = -4 + y * edge, back = -4 + (y + 1) * edge;
      out.polygon((x + y) % 2 == 0 ? dark : light, std::array{Vec3{left, front, 0}, Vec3{right, front, 0},
                                                              Vec3{right, back, 0}, Vec3{left, back, 0}});
    }
  }
  for (const Patch& patch : teapot()) writePatch(out, glaze, size, patch);
  out.endCrowd();
}

}  // namespace rayshade::spd
