// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/density.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace rayshade {

namespace {

constexpr int kIndexBits = 20;

auto place(const DensityGrid::Cube& c) { return std::tie(c.x, c.y, c.z); }

}  // namespace

double DensityGrid::side() const { return std::ldexp(1.0, exponent_); }

void DensityGrid::add(const Bounds& bounds) {
  if (bounds.empty() || !bounds.finite()) return;
  const Vec3 centre = bounds.centre();
  int needed;  // |centre| < 2^needed
  std::frexp(maxAbs(centre), &needed);
  if (maxAbs(centre) > 0 && exponent_ < needed - kIndexBits) coarsen(needed - kIndexBits - exponent_);
  const auto index = [&](double x) {
    return static_cast<std::int32_t>(std::floor(std::ldexp(x, -exponent_)));
  };
  if (cubes_.size() >= 2 * most_) merge();
  if (cubes_.size() == cubes_.capacity())
    cubes_.reserve(std::min(2 * most_, std::max<std::size_t>(64, 2 * cubes_.size())));
  cubes_.push_back({index(centre.x), index(centre.y), index(centre.z), 1});
}

std::span<const DensityGrid::Cube> DensityGrid::cubes() {
  merge();
  return cubes_;
}

void DensityGrid::coarsen(int steps) {
  exponent_ += steps;
  const int shift = std::min(steps, 31);
  for (Cube& c : cubes_) c = {c.x >> shift, c.y >> shift, c.z >> shift, c.count};  // towards minus infinity
}

// One entry per cube, and coarser cubes while there are too many.
void DensityGrid::merge() {
  for (;;) {
    std::sort(cubes_.begin(), cubes_.end());
    std::size_t kept = 0;
    for (const Cube& c : cubes_) {
      if (kept > 0 && place(cubes_[kept - 1]) == place(c)) {
        const std::uint32_t room = 0xffffffffu - cubes_[kept - 1].count;
        cubes_[kept - 1].count += std::min(room, c.count);
      } else {
        cubes_[kept++] = c;
      }
    }
    cubes_.resize(kept);
    if (kept <= most_) return;
    coarsen(1);
  }
}

}  // namespace rayshade
