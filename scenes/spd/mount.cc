// Mount: a fractal mountain with four glass spheres, a small pyramid of them, floating above: 2 * 4^size triangles.
//
// Midpoint displacement: the middle of an edge lies at the mean of its ends, the middle of a square at the mean of
// its four corners, plus random * distance between them (a square: its diagonal).  The random number belongs to the
// place, so neighbours agree on their common edge, nothing is stored, and a larger size only adds detail.
// Its distribution is that of the original scene (bell-shaped, deviation 0.257), its values are not: ours is a hash.
// Source: Fournier, Fussell & Carpenter, Computer Rendering of Stochastic Models, CACM 25(6), 1982; Haines 1987.
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstdint>

#include "scenes/spd/spd.h"

namespace rayshade::spd {

namespace {

constexpr int kLog2Places = 14;  // places per side of the mountain, the largest size
constexpr double kRoughness = 0.257;

struct Place {
  std::int32_t x, y;  // 0 ... 2^kLog2Places
};

Place between(Place a, Place b) { return {(a.x + b.x) / 2, (a.y + b.y) / 2}; }

// Mean 0, deviation 1: the sum of four uniform numbers, taken from a well mixed word (the finalizer of Stafford's
// variant 13 of MurmurHash3).
double randomAt(Place place) {
  std::uint64_t h = static_cast<std::uint64_t>(place.x) << 32 | static_cast<std::uint32_t>(place.y);
  h += 0x9e3779b97f4a7c15;
  h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9;
  h = (h ^ h >> 27) * 0x94d049bb133111eb;
  h ^= h >> 31;
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += static_cast<double>(h >> 16 * i & 0xffff);
  return (sum / 65535 - 2) * std::sqrt(3.0);
}

// A corner of the terrain.
struct Corner {
  Place place;
  double height;
};

Vec3 position(const Corner& corner) {
  const double step = std::ldexp(2.0, -kLog2Places);
  return {corner.place.x * step - 1, corner.place.y * step - 1, corner.height};
}

// Counter-clockwise from the corner with the least x and y; `edge` is its side [world units].
void divide(SceneWriter& out, MaterialId rock, int times, const std::array<Corner, 4>& square, double edge) {
  const auto& [a, b, c, d] = square;
  if (times == 0) {
    out.triangle(rock, {position(a), position(b), position(c)});
    out.triangle(rock, {position(c), position(d), position(a)});
    return;
  }
  const auto middle = [edge](const Corner& from, const Corner& to) {
    const Place place = between(from.place, to.place);
    return Corner{place, (from.height + to.height) / 2 + edge * kRoughness * randomAt(place)};
  };
  const Corner ab = middle(a, b), bc = middle(b, c), cd = middle(c, d), da = middle(d, a);
  const Place centrePlace = between(a.place, c.place);
  const double mean = (a.height + b.height + c.height + d.height) / 4;
  const Corner centre{centrePlace, mean + edge * std::sqrt(2.0) * kRoughness * randomAt(centrePlace)};
  divide(out, rock, times - 1, {a, ab, centre, da}, edge / 2);
  divide(out, rock, times - 1, {ab, b, bc, centre}, edge / 2);
  divide(out, rock, times - 1, {centre, bc, c, cd}, edge / 2);
  divide(out, rock, times - 1, {da, centre, cd, d}, edge / 2);
}

}  // namespace

void writeMount(int size, SceneWriter& out) {
  out.view({.eye = {-1.6, 1.6, 1.7}, .lookAt = {}});
  out.light({-100, -100, 100}, lightIntensity(1));
  const MaterialId glass = out.material({.ambient = {0.01, 0.01, 0.01},
                                         .diffuse = {0.01, 0.01, 0.01},
                                         .specular = 0.1,
                                         .specularPower = 101.148,
                                         .reflect = 1,
                                         .transparency = 0.9,
                                         .index = 1.5});
  const MaterialId rock = out.material({.ambient = {0.05, 0.045, 0.035}, .diffuse = {0.5, 0.45, 0.35}});
  out.beginCrowd(2 * power(4, size) + 4);

  // Four touching spheres; their centres are a regular tetrahedron around (-0.8, 0.8, 1), one corner up, one towards
  // the middle of the mountain.
  constexpr double kRadius = 0.17;
  const Vec3 pyramid{-0.8, 0.8, 1};
  const double up = kRadius * std::sqrt(1.5), down = up / 3, across = 2 * kRadius / std::sqrt(3.0);
  out.sphere(glass, pyramid + Vec3{0, 0, up}, kRadius);
  for (int third = 0; third < 3; ++third) {
    const double angle = std::acos(-1) * (-0.25 + 2.0 / 3 * third);
    out.sphere(glass, pyramid + Vec3{across * std::cos(angle), across * std::sin(angle), -down}, kRadius);
  }

  constexpr std::int32_t kEnd = 1 << kLog2Places;
  divide(out, rock, size,
         {Corner{{0, 0}, 0}, Corner{{kEnd, 0}, 0}, Corner{{kEnd, kEnd}, 0}, Corner{{0, kEnd}, 0}}, 2);
  out.endCrowd();
}

}  // namespace rayshade::spd
