// Mount: a fractal mountain with four glass spheres, a small pyramid of them, floating above: 2 * 4^size triangles.
//
// Midpoint displacement: the middle of an edge lies at the mean of its ends, the middle of a square at the mean of its
// four corners, plus a random number times the distance between them (in a square: its diagonal).  The random number
// belongs to the place, so neighbours agree on their common edge and nothing is stored.  Sizes 6 and 8 have the
// numbers of the scenes that are in use (8 is striped: there the numbers hardly depend on x); all others have numbers
// of our own, of the same distribution, and a larger size only adds detail.
// Source: Fournier, Fussell & Carpenter, Computer Rendering of Stochastic Models, CACM 25(6), 1982; Haines 1987; the
// random numbers were worked out from the heights in the files of the two sizes.
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstdint>

#include "rayshade/base/elementary.h"
#include "scenes/spd/spd.h"

namespace rayshade::spd {

namespace {

constexpr int kLog2Places = 15;  // places per side of the mountain; size is less
constexpr double kRoughness = 0.25491223;

struct Place {
  std::int32_t x, y;  // 0 ... 2^kLog2Places
};

Place between(Place a, Place b) { return {(a.x + b.x) / 2, (a.y + b.y) / 2}; }

// What makes the random number of a place, for a mountain of the given size.
std::uint32_t seedAt(Place place, int size) {
  const auto x = static_cast<std::uint32_t>(place.x), y = static_cast<std::uint32_t>(place.y);
  if (size == 6) return 21 + ((y + (x >> 8)) & 0xffff);
  if (size == 8) return 21 + ((y + (x << 8)) & 0xffff);
  std::uint64_t h =
      (std::uint64_t{x} << 32 | y) + 0x9e3779b97f4a7c15;  // the mixer of Steele et al., SplitMix, 2014
  h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9;
  h = (h ^ h >> 27) * 0x94d049bb133111eb;
  return static_cast<std::uint32_t>(h ^ h >> 31);
}

// A normally distributed number, deviation 1: Marsaglia's polar method, fed by the quick generator of Press et al.,
// Numerical Recipes, 1988, section 7.1.
double normal(std::uint32_t seed) {
  constexpr std::uint32_t kModulus = 134456;
  std::uint32_t state = seed % kModulus;
  const auto uniform = [&state] {  // -1 ... 1
    state = (state * 8121 + 28411) % kModulus;
    return 2.0 * state / kModulus - 1;
  };
  while (true) {
    const double a = uniform(), b = uniform(), r = a * a + b * b;
    if (r > 0 && r < 1) return a * std::sqrt(-2 * elementary::log(r) / r);
  }
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
void divide(SceneWriter& out, MaterialId rock, int size, int times, const std::array<Corner, 4>& square,
            double edge) {
  const auto& [a, b, c, d] = square;
  if (times == 0) {
    out.triangle(rock, {position(a), position(b), position(c)});
    out.triangle(rock, {position(c), position(d), position(a)});
    return;
  }
  const auto middle = [edge, size](const Corner& from, const Corner& to) {
    const Place place = between(from.place, to.place);
    return Corner{place, (from.height + to.height) / 2 + edge * kRoughness * normal(seedAt(place, size))};
  };
  const Corner ab = middle(a, b), bc = middle(b, c), cd = middle(c, d), da = middle(d, a);
  const Place centrePlace = between(a.place, c.place);
  const double mean = (a.height + b.height + c.height + d.height) / 4;
  const Corner centre{centrePlace,
                      mean + edge * std::sqrt(2.0) * kRoughness * normal(seedAt(centrePlace, size))};
  divide(out, rock, size, times - 1, {a, ab, centre, da}, edge / 2);
  divide(out, rock, size, times - 1, {ab, b, bc, centre}, edge / 2);
  divide(out, rock, size, times - 1, {centre, bc, c, cd}, edge / 2);
  divide(out, rock, size, times - 1, {da, centre, cd, d}, edge / 2);
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
    const double angle = elementary::acos(-1) * (-0.25 + 2.0 / 3 * third);
    out.sphere(glass, pyramid + Vec3{across * elementary::cos(angle), across * elementary::sin(angle), -down},
               kRadius);
  }

  constexpr std::int32_t kEnd = 1 << kLog2Places;
  divide(out, rock, size, size,
         {Corner{{0, 0}, 0}, Corner{{kEnd, 0}, 0}, Corner{{kEnd, kEnd}, 0}, Corner{{0, kEnd}, 0}}, 2);
  out.endCrowd();
}

}  // namespace rayshade::spd
