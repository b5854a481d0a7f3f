// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/accel/bvh_ray.h"

#include <algorithm>

namespace rayshade::bvh_detail {
namespace {

typedef double Double2 __attribute__((vector_size(16)));

// Three axes as two pairs, for arithmetic on all of them at once; the fourth element is spare.
struct Axes {
  Double2 xy, z;

  Axes(Double2 a, Double2 b) : xy(a), z(b) {}
  explicit Axes(const Vec3& v) : xy{v.x, v.y}, z{v.z, v.z} {}
  Float4 rounded() const {
    return Float4{static_cast<float>(xy[0]), static_cast<float>(xy[1]), static_cast<float>(z[0]), 0};
  }
  friend Axes operator+(Axes a, Axes b) { return {a.xy + b.xy, a.z + b.z}; }
  friend Axes operator-(Axes a, Axes b) { return {a.xy - b.xy, a.z - b.z}; }
  friend Axes operator*(Axes a, Axes b) { return {a.xy * b.xy, a.z * b.z}; }
  friend Axes operator+(double s, Axes a) { return {s + a.xy, s + a.z}; }
  friend Axes operator*(double s, Axes a) { return {s * a.xy, s * a.z}; }
  friend Axes operator/(double s, Axes a) { return {s / a.xy, s / a.z}; }
};

Axes abs(Axes a) {
  const auto positive = [](Double2 x) {
    return reinterpret_cast<Double2>(reinterpret_cast<Long2>(x) & 0x7fffffffffffffff);
  };
  return {positive(a.xy), positive(a.z)};
}
// Of each axis `yes` where `chosen` is above 0, else `no`.
Axes select(Axes chosen, Axes yes, Axes no) {
  return {chosen.xy > 0.0 ? yes.xy : no.xy, chosen.z > 0.0 ? yes.z : no.z};
}

// Each axis as a vector of its own.
void spread(Float4 from, Float4 (&axes)[3]) {
  axes[0] = splat(from[0]);
  axes[1] = splat(from[1]);
  axes[2] = splat(from[2]);
}

}  // namespace

Entry enter(const BvhTree& tree, const Vec3& origin, const Vec3& direction, double tMin, double tMax,
            BoxRay& ray) {
  if (!isFinite(origin) || !isFinite(direction)) return Entry::kMissed;
  const double reach = maxAbs(direction);
  if (reach != 0 && !(reach >= margins::kSmallest && reach <= margins::kLargest)) return Entry::kEverything;
  const Vec3 q = (origin - tree.centre) * tree.scale;
  if (!(maxAbs(q) <= margins::kFarthest)) return Entry::kEverything;
  const double stretch = reach != 0 ? powerOfTwo(exponentOf(reach)) : 1.0;
  const Vec3 d = direction * (1 / stretch);
  ray.scale = stretch * tree.scale;

  double start = tMin * ray.scale, end = tMax * ray.scale;
  const Axes q2(q), d2(d), low2(tree.box.low), high2(tree.box.high);
  const Axes exactly = 1.0 / d2, far2 = abs(q2);
  const Axes slack = margins::kSlack * (1.0 + far2);
  const Axes toLow = (low2 - slack - q2) * exactly, toHigh = (high2 + slack - q2) * exactly;
  const Axes near = select(exactly, toLow, toHigh), far = select(exactly, toHigh, toLow);
  const auto enterSlab = [&start, &end](double from, double to) {
    start = from > start ? from : start;
    end = to < end ? to : end;
  };
  enterSlab(near.xy[0], far.xy[0]);
  enterSlab(near.xy[1], far.xy[1]);
  enterSlab(near.z[0], far.z[0]);
  if (!(start <= end)) return Entry::kMissed;
  // Infinite only for a ray that stands still, where any number will do.
  start = std::clamp(start, -margins::kLargest, margins::kLargest);
  ray.start = start;
  ray.setLimit(tMax);

  const Axes step = start * d2, p = q2 + step;
  const Axes margin = margins::kToFloat * abs(p) + 2 * margins::kSlack * (1.0 + far2 + abs(step));
  const Float4 place = p.rounded(), moved = margin.rounded();
  ray.direction = d2.rounded();
  // Off the axes and the planes of the box: at least the flattest, with its sign.
  const auto steepest = [](double x) { return std::copysign(margins::kSteepestInverse, x); };
  const Axes flattest(Vec3{margins::kFlattest, margins::kFlattest, margins::kFlattest});
  const Axes least(Vec3{steepest(d.x), steepest(d.y), steepest(d.z)});
  const Float4 inverse = select(abs(d2) - flattest, exactly, least).rounded();
  const Float4 forward = inverse > Float4{} ? moved : -moved;
  spread(place + forward, ray.nearOrigin);
  spread(place - forward, ray.farOrigin);
  spread(inverse * splat(1 - margins::kSlab), ray.nearInverse);
  spread(inverse * splat(1 + margins::kSlab), ray.farInverse);
  ray.octant = static_cast<std::uint32_t>(std::signbit(d.x)) |
               static_cast<std::uint32_t>(std::signbit(d.y)) << 1 |
               static_cast<std::uint32_t>(std::signbit(d.z)) << 2;
  return Entry::kEntered;
}

}  // namespace rayshade::bvh_detail
