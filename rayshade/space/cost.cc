// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/cost.h"

#include <algorithm>
#include <cmath>

#include "rayshade/base/elementary.h"

namespace rayshade {
namespace {

constexpr int kSide = 32;        // cells of the grid along each axis
constexpr int kRays = 64;        // primary rays along each side of the picture
constexpr double kVisit = 0.1;   // work of a ray that passes, in parts of one that is stopped; by measurement
constexpr double kFaint = 1e-3;  // a ray of less than this is not followed

struct ExtinctionGrid {
  Bounds world;
  Vec3 cell;  // size of a cell                                                              [world units]
  std::vector<Vec3> extinction =
      std::vector<Vec3>(kSide * kSide * kSide);  // of a ray along each axis, per unit of length

  static std::size_t at(int x, int y, int z) { return static_cast<std::size_t>((z * kSide + y) * kSide + x); }
  int index(double coordinate, int axis) const {
    const double i = std::floor((coordinate - world.low[axis]) / cell[axis]);
    return i > 0 ? static_cast<int>(std::min(i, kSide - 1.0)) : 0;
  }
};

ExtinctionGrid hazeOf(const Bounds& world, const BoundsSample& sample) {
  ExtinctionGrid haze{world, world.size() * (1.0 / kSide)};
  const double volume = haze.cell.x * haze.cell.y * haze.cell.z;
  for (const BoundsSample::Box& box : sample.boxes()) {
    int from[3], to[3];
    for (int axis = 0; axis < 3; ++axis) {
      from[axis] = haze.index(box.bounds.low[axis], axis);
      to[axis] = haze.index(box.bounds.high[axis], axis);
    }
    const double cells = double(to[0] - from[0] + 1) * (to[1] - from[1] + 1) * (to[2] - from[2] + 1);
    const Vec3 size = box.bounds.size();
    const Vec3 sides{size.y * size.z, size.z * size.x, size.x * size.y};
    const Vec3 share = sides * (box.weight / (volume * cells));
    for (int z = from[2]; z <= to[2]; ++z)
      for (int y = from[1]; y <= to[1]; ++y)
        for (int x = from[0]; x <= to[0]; ++x)
          haze.extinction[ExtinctionGrid::at(x, y, z)] = haze.extinction[ExtinctionGrid::at(x, y, z)] + share;
  }
  return haze;
}

// Follows a ray of strength `strength` up to the distance `end`; calls f(cell, arriving, stopped) for each cell.
// Source: Amanatides & Woo 1987, A fast voxel traversal algorithm.
template <class F>
void march(const ExtinctionGrid& haze, const Vec3& origin, const Vec3& direction, double end, double strength,
           F f) {
  double begin = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (haze.world.low[axis] - origin[axis]) / direction[axis];
    const double b = (haze.world.high[axis] - origin[axis]) / direction[axis];
    if (direction[axis] == 0) {
      if (origin[axis] < haze.world.low[axis] || origin[axis] > haze.world.high[axis]) return;
      continue;
    }
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (!(begin < end)) return;
  int index[3], step[3];
  double next[3], pace[3];
  for (int axis = 0; axis < 3; ++axis) {
    index[axis] = haze.index(origin[axis] + begin * direction[axis], axis);
    step[axis] = direction[axis] < 0 ? -1 : 1;
    const double border = haze.world.low[axis] + haze.cell[axis] * (index[axis] + (step[axis] > 0 ? 1 : 0));
    next[axis] = direction[axis] == 0 ? kInfinity : (border - origin[axis]) / direction[axis];
    pace[axis] = direction[axis] == 0 ? kInfinity : haze.cell[axis] / std::abs(direction[axis]);
  }
  for (double t = begin; t < end && strength > kFaint;) {
    const int axis = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    const double exit = std::min(end, next[axis]);
    const std::size_t cell = ExtinctionGrid::at(index[0], index[1], index[2]);
    const Vec3& along = haze.extinction[cell];
    const double extinction =
        along.x * std::abs(direction.x) + along.y * std::abs(direction.y) + along.z * std::abs(direction.z);
    // Most cells are empty.
    const double stopped =
        extinction > 0 ? strength * -elementary::expm1(-extinction * std::max(0.0, exit - t)) : 0;
    f(cell, strength, stopped);
    strength -= stopped;
    t = exit;
    next[axis] += pace[axis];
    index[axis] += step[axis];
    if (index[axis] < 0 || index[axis] >= kSide) return;
  }
}

}  // namespace

std::vector<CostBox> predictCost(const Bounds& world, const BoundsSample& sample, const View& view,
                                 const PictureSpec& picture, const SceneSettings& settings) {
  const std::optional<PixelArea> area = pixelArea(picture);
  if (world.empty() || !world.finite() || !area) return {};
  const double length = maxAbs(world.size()), least = length * 0x1p-20;
  if (!(length > 0x1p-250 && length < 0x1p+250)) return {};  // volumes would leave the range of doubles
  Bounds box = world;
  for (int axis = 0; axis < 3; ++axis) {  // a flat world gets some thickness
    if (box.size()[axis] >= least) continue;
    box.low[axis] -= least;
    box.high[axis] += least;
  }
  const ExtinctionGrid haze = hazeOf(box, sample);
  std::vector<double> cost(haze.extinction.size()), hits(haze.extinction.size());
  for (int v = 0; v < kRays; ++v) {
    for (int u = 0; u < kRays; ++u) {
      const double x = area->x + (u + 0.5) / kRays * area->width,
                   y = area->y + (v + 0.5) / kRays * area->height;
      march(haze, view.eye, normalize(view.first + x * view.right + y * view.down), kInfinity, 1,
            [&](std::size_t cell, double arriving, double stopped) {
              cost[cell] += kVisit * arriving + stopped;
              hits[cell] += stopped;
            });
    }
  }
  auto centre = [&](std::size_t cell) {
    const double i[3] = {double(cell % kSide), double(cell / kSide % kSide), double(cell / kSide / kSide)};
    return Vec3{box.low.x + haze.cell.x * (i[0] + 0.5), box.low.y + haze.cell.y * (i[1] + 0.5),
                box.low.z + haze.cell.z * (i[2] + 0.5)};
  };
  for (std::size_t cell = 0; settings.shadows && cell < hits.size(); ++cell) {
    if (hits[cell] <= kFaint) continue;
    for (const LightSource& light : settings.lights) {
      if (!light.castsShadows) continue;
      const int points = pointsOf(light);
      const LightSample sample = sampleLight(light, LightQuery{.position = centre(cell)}, points / 2);
      march(
          haze, centre(cell), sample.shadowToward, sample.shadowDistance, hits[cell] * points,
          [&](std::size_t at, double arriving, double stopped) { cost[at] += kVisit * arriving + stopped; });
    }
  }
  std::vector<CostBox> boxes;
  for (std::size_t cell = 0; cell < cost.size(); ++cell)
    if (cost[cell] > 0)
      boxes.push_back({Bounds{centre(cell) - haze.cell * 0.5, centre(cell) + haze.cell * 0.5}, cost[cell]});
  return boxes;
}

}  // namespace rayshade
