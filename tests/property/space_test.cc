// Random rays through random items, half of them aimed where rounding hurts.
//
// Coordinates are small multiples of a power of two where a question has to have an exact answer: then the
// ray o + t d meets faces, edges and corners exactly, and brute force in double is exact, too.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "rayshade/accel/bvh.h"
#include "rayshade/shapes/sphere.h"
#include "rayshade/space/walk.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

struct Line {
  Vec3 origin, direction;
};

// Exact for the lattice lines below: all t are multiples of 1/12, compared without division.
bool touchesExactly(const Bounds& box, const Line& line, double tMin, double tMax) {
  // Every t of a plane is n / d with integers of few bits: the common denominator of 1, 2, 3, 4 is 12.
  double low = tMin * 12, high = tMax * 12;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = line.origin[axis], d = line.direction[axis];
    if (d == 0) {
      if (o < box.low[axis] || o > box.high[axis]) return false;
      continue;
    }
    const double first = (box.low[axis] - o) * (12 / d), second = (box.high[axis] - o) * (12 / d);
    low = std::max(low, std::min(first, second));
    high = std::min(high, std::max(first, second));
  }
  return low <= high;
}

std::set<std::uint32_t> offered(const Bvh& bvh, const Line& line, double tMin, double tMax) {
  std::set<std::uint32_t> found;
  bvh.nearest(line.origin, line.direction, tMin, tMax, [&](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t i = first; i < first + count; ++i) found.insert(bvh.order()[i]);
  });
  return found;
}

// Boxes on a lattice; rays through lattice points, along directions of small integers: corners, edges and
// faces are met exactly, origins lie on them, and many components are zero.
TEST(Space, TheBvhNeverMissesABoxThatTheExactRayTouches) {
  int touched = 0;
  for (std::uint64_t scene = 0; scene < 60; ++scene) {
    SeededRandom random(scene);
    const double scale = std::ldexp(1.0, random.integer(-3, 3) * 40);
    const Vec3 shift = scene % 3 == 0 ? random.lattice(-1000000, 1000000) : Vec3{};
    std::vector<Bounds> lattice, items;
    for (int i = random.integer(1, 200); i > 0; --i) {
      const Vec3 low = random.lattice(-20, 20) + shift;
      lattice.push_back({low, low + random.lattice(0, 3)});
      items.push_back({lattice.back().low * scale, lattice.back().high * scale});
    }
    const Bvh bvh(items);
    for (int i = 0; i < 400; ++i) {
      const Bounds& aim = random.pick(lattice);
      Line line{{}, random.lattice(-4, 4)};
      if (random.integer(0, 3) == 0) line.direction[random.integer(0, 2)] = -0.0;
      Vec3 target;
      for (int axis = 0; axis < 3; ++axis) {
        const int where = random.integer(0, 2);
        target[axis] = where == 0   ? aim.low[axis]
                       : where == 1 ? aim.high[axis]
                                    : random.integer(int(aim.low[axis]), int(aim.high[axis]));
      }
      const int distances[] = {0, 1, 7, 50, 1 << 27};
      line.origin = target - line.direction * distances[random.integer(0, 4)];
      const double tMin = random.integer(0, 2) == 0 ? random.integer(0, 30) : 0;
      const double tMax = random.integer(0, 2) == 0 ? tMin + random.integer(0, 30) : kInfinity;
      const double stretch = std::ldexp(1.0, random.integer(-1, 1) * 30);
      const auto found = offered(bvh, {line.origin * scale, line.direction * (scale * stretch)},
                                 tMin / stretch, tMax / stretch);
      for (std::uint32_t k = 0; k < items.size(); ++k)
        if (touchesExactly(lattice[k], line, tMin, tMax)) {
          ++touched;
          ASSERT_TRUE(found.contains(k)) << "scene " << scene << " ray " << i << " item " << k;
        }
    }
  }
  EXPECT_GT(touched, 20000);
}

struct Nearest {
  double t = kInfinity;
  std::uint32_t item = 0xffffffffu;
  friend bool operator==(const Nearest&, const Nearest&) = default;
};

// The total order of hits: t, then number.
void take(Nearest& best, double t, std::uint32_t item) {
  if (t < best.t || (t == best.t && t < kInfinity && item < best.item)) best = {t, item};
}

struct SphereScene {
  std::vector<Sphere> spheres;
  std::vector<Bounds> bounds;
};

// One in ten twice, some on lattice points so that hits tie.
SphereScene sphereScene(Random& random, int n, double scale) {
  SphereScene scene;
  for (int i = 0; i < n; ++i) {
    if (i > 0 && random.integer(0, 9) == 0) {
      scene.spheres.push_back(Sphere{scene.spheres[random.integer(0, i - 1)]});
      continue;
    }
    Sphere s{random.point(0, 10), random.real(0.01, 0.8)};
    if (random.integer(0, 4) == 0) s = {random.lattice(0, 10), random.integer(1, 4) * 0.25};
    scene.spheres.push_back({s.centre * scale, s.radius * scale});
  }
  for (const Sphere& s : scene.spheres) scene.bounds.push_back(padded(s.bounds()));
  return scene;
}

LocalRay localRay(const Line& line) {
  LocalRay ray;
  ray.origin = line.origin;
  ray.direction = line.direction;
  return ray;
}

// Half of the rays at tangents, poles (where a sphere touches its bounds) and planes of the tree.
Line hardLine(Random& random, const SphereScene& scene, const BinTree& tree, double scale) {
  const double distances[] = {0, 0.5, 5, 100, 1e9};
  const double distance = distances[random.integer(0, 4)] * scale;
  Line line{random.point(-3, 13) * scale, random.direction()};
  const int kind = random.integer(0, 7);
  if (kind < 4) return line;
  Vec3 target = random.point(0, 10) * scale;
  const Sphere& s = random.pick(scene.spheres);
  if (kind == 4) {  // tangent
    target = s.centre + s.radius * normalize(cross(line.direction, random.direction()));
  } else if (kind == 5) {  // pole
    target = s.centre;
    target[random.integer(0, 2)] += random.integer(0, 1) * 2 * s.radius - s.radius;
  } else {  // on a plane, or at where a sphere meets it
    const BinNode& node = random.pick(tree.nodes);
    if (!node.leaf()) {
      if (kind == 7) target = s.centre + s.radius * random.direction();
      target[node.axis] = node.split;
      if (random.integer(0, 3) == 0) line.direction[node.axis] = random.integer(0, 1) == 0 ? 0.0 : -0.0;
    }
  }
  line.direction = normalize(line.direction);
  line.origin = target - line.direction * distance;
  return line;
}

Nearest bruteForce(const SphereScene& scene, const LocalRay& ray) {
  Nearest best;
  for (std::uint32_t i = 0; i < scene.spheres.size(); ++i) take(best, scene.spheres[i].intersect(ray, 0), i);
  return best;
}

TEST(Space, TheBvhFindsTheSameNearestSphereAsBruteForce) {
  int hits = 0;
  const double scales[] = {1, 0x1p-300, 0x1p+300, 1e-9, 1e9};
  for (std::uint64_t round = 0; round < 100; ++round) {
    SeededRandom random(1000 + round);
    const double scale = scales[round % 5];
    const SphereScene scene = sphereScene(random, random.integer(1, 150), scale);
    const Bvh bvh(scene.bounds);
    for (int i = 0; i < 500; ++i) {
      const LocalRay ray = localRay(hardLine(random, scene, BinTree{}, scale));
      const Nearest expected = bruteForce(scene, ray);
      Nearest found;
      double tMax = kInfinity;
      bvh.nearest(ray.origin, ray.direction, 0, tMax, [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t k = first; k < first + count; ++k)
          take(found, scene.spheres[bvh.order()[k]].intersect(ray, 0), bvh.order()[k]);
        tMax = found.t;
      });
      ASSERT_EQ(found, expected) << "round " << round << " ray " << i;
      const bool any =
          bvh.any(ray.origin, ray.direction, 0, kInfinity, [&](std::uint32_t first, std::uint32_t count) {
            for (std::uint32_t k = first; k < first + count; ++k)
              if (scene.spheres[bvh.order()[k]].intersect(ray, 0) < kInfinity) return true;
            return false;
          });
      ASSERT_EQ(any, expected.t < kInfinity);
      hits += any;
    }
  }
  EXPECT_GT(hits, 10000);
}

BinTree randomTree(Random& random, const SphereScene& scene, double scale) {
  DensityGrid grid(512);
  Bounds world;
  for (const Bounds& b : scene.bounds) {
    grid.add(b);
    world = join(world, b);
  }
  if (random.integer(0, 1) == 0) world = {{0, 0, 0}, Vec3{10, 10, 10} * scale};
  return buildBinTree(world, {.voxels = std::uint32_t(random.integer(1, 24)), .cells = 40}, grid);
}

template <class Id>
void expectPartition(const BinTree& tree, const Line& line) {
  Walk<Id> walk(tree, line.origin, line.direction);
  double t = 0;
  std::set<Id> seen;
  for (WalkStep<Id> step; walk.next(step);) {
    ASSERT_EQ(step.tEnter, t);
    ASSERT_LT(step.tEnter, step.tExit);
    ASSERT_TRUE(seen.insert(step.where).second);
    // A point of the interval lies in the box, up to rounding.
    const double middle = step.tExit < kInfinity ? step.tEnter * 0.5 + step.tExit * 0.5 : step.tEnter * 2 + 1;
    const Vec3 p = line.origin + line.direction * middle;
    const double margin = 1e-12 * (maxAbs(line.origin) + middle);
    const Bounds box = boundsOf(tree, step.where);
    ASSERT_TRUE(
        contains({box.low - Vec3{margin, margin, margin}, box.high + Vec3{margin, margin, margin}}, p));
    t = step.tExit;
  }
  ASSERT_EQ(t, kInfinity);
}

TEST(Space, AWalkIsAPartitionOfTheRay) {
  for (std::uint64_t round = 0; round < 60; ++round) {
    SeededRandom random(2000 + round);
    const SphereScene scene = sphereScene(random, 50, 1);
    const BinTree tree = randomTree(random, scene, 1);
    for (int i = 0; i < 300; ++i) {
      const Line line = hardLine(random, scene, tree, 1);
      expectPartition<VoxelId>(tree, line);
      expectPartition<CellId>(tree, line);
      if (HasFatalFailure()) return;
    }
  }
}

// What every task does: the nearest among the spheres that touch the region, accepted iff t < tExit.
template <class Id>
Nearest visitByVisit(const BinTree& tree, const SphereScene& scene,
                     const std::vector<std::vector<std::uint32_t>>& inside, const LocalRay& ray) {
  Walk<Id> walk(tree, ray.origin, ray.direction);
  for (WalkStep<Id> step; walk.next(step);) {
    Nearest best;
    for (const std::uint32_t i : inside[number(step.where)])
      take(best, scene.spheres[i].intersect(ray, 0), i);
    if (best.t < step.tExit) return best;
  }
  return {};
}

TEST(Space, VisitingRegionByRegionFindsWhatBruteForceFinds) {
  int hits = 0;
  const double scales[] = {1, 1, 1e-6, 1e6};
  for (std::uint64_t round = 0; round < 150; ++round) {
    SeededRandom random(3000 + round);
    const double scale = scales[round % 4];
    const SphereScene scene = sphereScene(random, 40, scale);
    const BinTree tree = randomTree(random, scene, scale);
    std::vector<std::vector<std::uint32_t>> voxels(voxelCount(tree)), cells(cellCount(tree));
    for (std::uint32_t i = 0; i < scene.spheres.size(); ++i) {
      std::vector<VoxelId> inVoxels;
      std::vector<CellId> inCells;
      voxelsTouching(tree, scene.bounds[i], inVoxels);
      cellsTouching(tree, scene.bounds[i], inCells);
      for (const VoxelId v : inVoxels) voxels[number(v)].push_back(i);
      for (const CellId c : inCells) cells[number(c)].push_back(i);
    }
    for (int i = 0; i < 1000; ++i) {
      const LocalRay ray = localRay(hardLine(random, scene, tree, scale));
      const Nearest expected = bruteForce(scene, ray);
      ASSERT_EQ(visitByVisit<VoxelId>(tree, scene, voxels, ray), expected)
          << "round " << round << " ray " << i;
      ASSERT_EQ(visitByVisit<CellId>(tree, scene, cells, ray), expected) << "round " << round << " ray " << i;
      hits += expected.t < kInfinity;
    }
  }
  EXPECT_GT(hits, 30000);
}

}  // namespace
}  // namespace rayshade
