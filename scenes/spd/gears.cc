// Gears: size^3 meshing gears with 36 teeth in `size` layers; polygons with 144 corners, coloured, every fifth
// one of glass.
//
// Size 4: the gears lie on a square of side 2, layers 1/4 apart, 1/10 thick; other sizes fill the same space.
// A gear is two faces and 144 side walls; with the floor 146 size^3 + 1 polygons.
// Source: Haines 1987 for the idea; the measures were taken from pictures and files of the original scene.
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <vector>

#include "rayshade/base/elementary.h"
#include "scenes/spd/spd.h"

namespace rayshade::spd {

namespace {

constexpr int kTeeth = 36;
constexpr int kCorners = 4 * kTeeth;

// In units in which the square is 0.38 size + 0.02 wide; the rim stays 0.001 clear of the neighbour's valley.
constexpr double kSpacing = 0.38, kMargin = 0.2, kTipRadius = 0.199, kValleyRadius = 0.18;
constexpr double kTipHalfWidth = 1.9, kValleyStart = 3, kTooth = 10;  // degrees

using Outline = std::array<Vec3, kCorners>;

Outline outline(bool turned) {
  Outline result;
  const double degree = elementary::acos(-1) / 180;
  for (int tooth = 0; tooth < kTeeth; ++tooth) {
    const double middle = kTooth * (tooth + (turned ? 0.5 : 0));
    const double angles[] = {middle - kTipHalfWidth, middle + kTipHalfWidth, middle + kValleyStart,
                             middle + kTooth - kValleyStart};
    for (int i = 0; i < 4; ++i) {
      const double radius = i < 2 ? kTipRadius : kValleyRadius;
      result[4 * tooth + i] = {radius * elementary::cos(angles[i] * degree),
                               radius * elementary::sin(angles[i] * degree), 0};
    }
  }
  return result;
}

// A colourful rule without random numbers: three numbers modulo 7, the strongest channel made 1.
Color tint(int x, int y, int layer) {
  const double r = (x + 3 * y + 5 * layer + 5) % 7 + 0.07;
  const double g = (3 * x + 2 * y + 6 * layer + 3) % 7 + 0.07;
  const double b = (4 * x + 2 * y + 6 * layer + 2) % 7 + 0.07;
  const Color color{r, g, b};
  return {r / largest(color), g / largest(color), b / largest(color)};
}

Material gearMaterial(int x, int y, int layer) {
  const Color color = tint(x, y, layer);
  if ((x + 3 * y + 4 * layer) % 5 == 0) {
    return {.ambient = color * 0.02, .diffuse = color * 0.04, .transparency = 0.8, .index = 1.1};
  }
  return {.ambient = color * 0.1, .diffuse = color};
}

void gear(SceneWriter& out, MaterialId material, const Outline& outline, Vec3 centre, double scale,
          double thickness) {
  Outline top, bottom;
  for (int i = 0; i < kCorners; ++i) {
    top[i] = centre + outline[i] * scale;
    bottom[i] = top[i] - Vec3{0, 0, thickness};
  }
  Outline seenFromBelow;
  for (int i = 0; i < kCorners; ++i) seenFromBelow[i] = bottom[(kCorners + 1 - i) % kCorners];
  out.polygon(material, top);
  out.polygon(material, seenFromBelow);
  for (int i = 0; i < kCorners; ++i) {
    const int next = (i + 1) % kCorners;
    out.polygon(material, std::array{top[i], bottom[i], bottom[next], top[next]});
  }
}

}  // namespace

void writeGears(int size, SceneWriter& out) {
  out.view({.eye = {-1.1, -2.1, 2.6}, .lookAt = {}});
  for (const Vec3 position :
       {Vec3{2, 4, 4}, Vec3{-2, 4, 3}, Vec3{2, -2.5, 2.5}, Vec3{-1, -4, 2}, Vec3{-1.111, -2.121, 2.626}}) {
    out.light(position, lightIntensity(5));
  }
  const MaterialId floor = out.material({.ambient = {0.1, 0.085, 0.07},
                                         .diffuse = {0.3, 0.255, 0.21},
                                         .specular = 0.6,
                                         .specularPower = 3.0827,
                                         .reflect = 1});
  out.polygon(floor, std::array{Vec3{2, 2, 0}, Vec3{-2, 2, 0}, Vec3{-2, -2, 0}, Vec3{2, -2, 0}});

  const double scale = 2 / (kSpacing * size + 0.02);
  const Outline straight = outline(false), turned = outline(true);
  const std::uint64_t gears = power(size, 3);
  // A crowd starts after all its materials; they are as many as gears.
  std::vector<MaterialId> materials;
  materials.reserve(gears);
  for (int layer = 0; layer < size; ++layer) {
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) materials.push_back(out.material(gearMaterial(x, y, layer)));
    }
  }
  out.beginCrowd(gears * (kCorners + 2));
  for (int layer = 0; layer < size; ++layer) {
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        const Vec3 centre{-1 + (kMargin + kSpacing * x) * scale, -1 + (kMargin + kSpacing * y) * scale,
                          1 - static_cast<double>(layer) / size};
        gear(out, materials[x + size * (y + size * layer)], (x + y + layer) % 2 == 0 ? straight : turned,
             centre, scale, 0.4 / size);
      }
    }
  }
  out.endCrowd();
}

}  // namespace rayshade::spd
