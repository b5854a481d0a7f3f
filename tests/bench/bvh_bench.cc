// How fast is the accelerator: builds in items per second, rays per second.
//
// Spheres of random sizes that overlap a little, and a terrain of triangles, as in the standard procedural
// scenes.  Rays start outside and aim at random points within (random order: no help from the caches), or
// come from one eye in the order of a picture.
// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>

#include <cmath>

#include "rayshade/accel/bvh.h"
#include "tests/support/random.h"

namespace rayshade {
namespace {

struct Ball {
  Vec3 centre;
  double radius;
};
struct Facet {
  Vec3 corner, first, second;
};

std::vector<Ball> balls(int n) {
  std::vector<Ball> list;
  const double size = 0.7 / std::cbrt(n);
  Random random(1);
  for (int i = 0; i < n; ++i) {
    const Vec3 centre = random.point(0, 1);
    list.push_back({centre, size * random.real(0.2, 1)});
  }
  return list;
}

std::vector<Facet> terrain(int side) {
  const auto at = [&](int x, int y) {
    const double u = double(x) / side, v = double(y) / side;
    return Vec3{u, v, 0.5 + 0.1 * std::sin(9 * u) * std::cos(7 * v) + 0.01 * Random(x * 4096 + y).real()};
  };
  std::vector<Facet> list;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y) {
      const Vec3 a = at(x, y), b = at(x + 1, y), c = at(x, y + 1), d = at(x + 1, y + 1);
      list.push_back({a, b - a, c - a});
      list.push_back({d, c - d, b - d});
    }
  return list;
}

Bounds boundsOf(const Ball& b) {
  const Vec3 r{b.radius, b.radius, b.radius};
  return padded({b.centre - r, b.centre + r});
}
Bounds boundsOf(const Facet& f) {
  return padded(join(join(Bounds{f.corner, f.corner}, f.corner + f.first), f.corner + f.second));
}

double intersect(const Ball& b, Vec3 o, Vec3 d) {
  const Vec3 f = o - b.centre;
  const double middle = -dot(f, d);
  const Vec3 foot = f + middle * d;
  const double quarter = b.radius * b.radius - dot(foot, foot);
  if (quarter < 0) return kInfinity;
  const double t = middle - std::sqrt(quarter);
  return t > 0 ? t : kInfinity;
}
double intersect(const Facet& f, Vec3 o, Vec3 d) {
  const Vec3 p = cross(d, f.second);
  const double scale = 1 / dot(f.first, p);
  const Vec3 s = o - f.corner;
  const double u = dot(s, p) * scale;
  if (!(u >= 0 && u <= 1)) return kInfinity;
  const Vec3 q = cross(s, f.first);
  const double v = dot(d, q) * scale;
  if (!(v >= 0 && u + v <= 1)) return kInfinity;
  const double t = dot(f.second, q) * scale;
  return t > 0 ? t : kInfinity;
}

struct Line {
  Vec3 origin, direction;
};
enum Rays { kScattered, kPicture };
Line line(std::uint64_t i, Rays kind) {
  if (kind == kScattered) {
    Random random(i);
    const Vec3 from = random.point(-0.5, 1.5);
    return {from, normalize(random.point(0, 1) - from)};
  }
  const double x = double(i % 512) / 512, y = double(i / 512 % 512) / 512;
  return {{0.5, -1.2, 1.1}, normalize(Vec3{1.4 * (x - 0.5), 1.5, 1.2 * (y - 0.5) - 0.6})};
}

template <class Item>
void nearest(benchmark::State& state, const std::vector<Item>& items, Rays kind) {
  std::vector<Bounds> bounds;
  for (const Item& item : items) bounds.push_back(boundsOf(item));
  const Bvh bvh(bounds);
  std::vector<Item> ordered;
  for (const std::uint32_t item : bvh.order()) ordered.push_back(items[item]);
  std::vector<Line> lines;
  for (std::uint64_t i = 0; i < (1 << 18); ++i) lines.push_back(line(i, kind));
  std::uint64_t i = 0, tests = 0, hits = 0;
  for (auto _ : state) {
    const Line& ray = lines[i++ & (lines.size() - 1)];
    double tMax = kInfinity;
    bvh.nearest(ray.origin, ray.direction, 0, tMax, [&](std::uint32_t first, std::uint32_t count) {
      for (std::uint32_t k = first; k < first + count; ++k)
        tMax = std::min(tMax, intersect(ordered[k], ray.origin, ray.direction));
      tests += count;
    });
    hits += tMax < kInfinity;
  }
  state.counters["rays/s"] = benchmark::Counter(double(i), benchmark::Counter::kIsRate);
  state.counters["tests/ray"] = double(tests) / double(i);
  state.counters["hit"] = double(hits) / double(i);
  state.counters["B/item"] = double(bvh.bytes()) / double(items.size());
}

template <class Item>
void any(benchmark::State& state, const std::vector<Item>& items) {
  std::vector<Bounds> bounds;
  for (const Item& item : items) bounds.push_back(boundsOf(item));
  const Bvh bvh(bounds);
  std::vector<Item> ordered;
  for (const std::uint32_t item : bvh.order()) ordered.push_back(items[item]);
  std::vector<Line> lines;
  for (std::uint64_t i = 0; i < (1 << 18); ++i) lines.push_back(line(i, kScattered));
  std::uint64_t i = 0;
  for (auto _ : state) {
    const Line& ray = lines[i++ & (lines.size() - 1)];
    benchmark::DoNotOptimize(
        bvh.any(ray.origin, ray.direction, 0, kInfinity, [&](std::uint32_t first, std::uint32_t count) {
          for (std::uint32_t k = first; k < first + count; ++k)
            if (intersect(ordered[k], ray.origin, ray.direction) < kInfinity) return true;
          return false;
        }));
  }
  state.counters["rays/s"] = benchmark::Counter(double(i), benchmark::Counter::kIsRate);
}

void buildBalls(benchmark::State& state) {
  std::vector<Bounds> bounds;
  for (const Ball& ball : balls(static_cast<int>(state.range(0)))) bounds.push_back(boundsOf(ball));
  for (auto _ : state) benchmark::DoNotOptimize(Bvh(bounds).bytes());
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
void nearestBalls(benchmark::State& state) {
  nearest(state, balls(static_cast<int>(state.range(0))), Rays(state.range(1)));
}
void anyBalls(benchmark::State& state) { any(state, balls(static_cast<int>(state.range(0)))); }
void nearestTerrain(benchmark::State& state) { nearest(state, terrain(256), Rays(state.range(0))); }
void anyTerrain(benchmark::State& state) { any(state, terrain(256)); }

BENCHMARK(buildBalls)->Arg(8000)->Arg(600000)->Unit(benchmark::kMillisecond);
BENCHMARK(nearestBalls)->ArgsProduct({{8000, 80000, 600000}, {kScattered, kPicture}});
BENCHMARK(nearestTerrain)->Arg(kScattered)->Arg(kPicture);
BENCHMARK(anyBalls)->Arg(8000)->Arg(600000);
BENCHMARK(anyTerrain);

}  // namespace
}  // namespace rayshade

BENCHMARK_MAIN();
