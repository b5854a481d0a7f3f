// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/density.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

Bounds point(double x, double y, double z) { return {{x, y, z}, {x, y, z}}; }

std::vector<Bounds> randomPoints(int n, double size) {
  std::vector<Bounds> list;
  Random random(1);
  for (int i = 0; i < n; ++i) {
    const Vec3 p = random.point(-size / 2, size / 2);
    list.push_back({p, p});
  }
  return list;
}

TEST(DensityGrid, IsEmptyWhenNothingIsCounted) {
  DensityGrid grid;
  EXPECT_TRUE(grid.cubes().empty());
  grid.add(Bounds{});
  grid.add(kEverywhere);
  grid.add({{0, 0, std::nan("")}, {1, 1, 1}});
  EXPECT_TRUE(grid.cubes().empty());
}

TEST(DensityGrid, CountsObjectsInTheCubeOfTheirCentre) {
  DensityGrid grid;
  grid.add({{0, 0, 0}, {1, 2, 4}});
  grid.add({{-1, 0, 1}, {2, 2, 3}});
  grid.add(point(-1, 0, 0));
  ASSERT_EQ(grid.cubes().size(), 2u);
  EXPECT_EQ(grid.cubes()[0].x * grid.side(), -1);
  EXPECT_EQ(grid.cubes()[0].count, 1u);
  EXPECT_EQ(grid.cubes()[1].x * grid.side(), 0.5);
  EXPECT_EQ(grid.cubes()[1].y * grid.side(), 1);
  EXPECT_EQ(grid.cubes()[1].z * grid.side(), 2);
  EXPECT_EQ(grid.cubes()[1].count, 2u);
}

TEST(DensityGrid, DoesNotDependOnTheOrderOfObjects) {
  std::vector<Bounds> objects = randomPoints(5000, 100);
  objects.push_back(point(1e7, 0, 0));
  objects.push_back(point(0, 0, 0));
  objects.push_back(point(0, -1e-9, 0));
  std::vector<std::vector<DensityGrid::Cube>> seen;
  std::vector<double> sides;
  SeededRandom random(2);
  for (int round = 0; round < 4; ++round) {
    DensityGrid grid(300);
    for (const Bounds& b : objects) grid.add(b);
    seen.emplace_back(grid.cubes().begin(), grid.cubes().end());
    sides.push_back(grid.side());
    random.shuffle(objects);
    if (round == 0) std::reverse(objects.begin(), objects.end());
  }
  for (std::size_t i = 1; i < seen.size(); ++i) {
    EXPECT_EQ(seen[i], seen[0]);
    EXPECT_EQ(sides[i], sides[0]);
  }
}

TEST(DensityGrid, AskingInBetweenChangesNothing) {
  DensityGrid asked(100), silent(100);
  for (const Bounds& b : randomPoints(1000, 8)) {
    asked.add(b);
    asked.cubes();
    silent.add(b);
  }
  const std::vector<DensityGrid::Cube> expected(silent.cubes().begin(), silent.cubes().end());
  EXPECT_EQ(std::vector<DensityGrid::Cube>(asked.cubes().begin(), asked.cubes().end()), expected);
}

TEST(DensityGrid, MemoryAndCubesAreBoundedAndNoObjectIsLost) {
  DensityGrid grid(1000);
  std::uint64_t objects = 0;
  for (const Bounds& b : randomPoints(50000, 1e3)) {
    grid.add(b);
    ++objects;
    ASSERT_LE(grid.bytes(), 2 * 1000 * sizeof(DensityGrid::Cube));
  }
  EXPECT_LE(grid.cubes().size(), 1000u);
  EXPECT_GE(grid.cubes().size(), 100u);  // coarse, but no coarser than needed
  std::uint64_t counted = 0;
  for (const DensityGrid::Cube& c : grid.cubes()) counted += c.count;
  EXPECT_EQ(counted, objects);
}

TEST(DensityGrid, CubesHoldTheirObjects) {
  const std::vector<Bounds> objects = randomPoints(2000, 50);
  DensityGrid grid(64);
  for (const Bounds& b : objects) grid.add(b);
  for (const DensityGrid::Cube& c : grid.cubes()) {
    const Vec3 low{c.x * grid.side(), c.y * grid.side(), c.z * grid.side()};
    const auto inside = std::count_if(objects.begin(), objects.end(), [&](const Bounds& b) {
      const Vec3 p = b.low - low;
      return p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < grid.side() && p.y < grid.side() && p.z < grid.side();
    });
    EXPECT_EQ(c.count, inside);
  }
}

TEST(DensityGrid, BearsAnySize) {
  DensityGrid grid(16);
  for (const double x : {1e-320, -1e-300, 1.0, 1e300, -1.7e308}) grid.add(point(x, 0, 0));
  EXPECT_LE(grid.cubes().size(), 16u);
  EXPECT_EQ(grid.cubes().back().x * grid.side(), std::floor(1e300 / grid.side()) * grid.side());
}

TEST(DensityGrid, AScaleByAPowerOfTwoScalesTheCubes) {
  DensityGrid one(200), other(200);
  for (const Bounds& b : randomPoints(3000, 10)) {
    one.add(b);
    other.add({b.low * 0x1p-20, b.high * 0x1p-20});
  }
  EXPECT_EQ(std::vector<DensityGrid::Cube>(one.cubes().begin(), one.cubes().end()),
            std::vector<DensityGrid::Cube>(other.cubes().begin(), other.cubes().end()));
  EXPECT_EQ(one.side() * 0x1p-20, other.side());
}

}  // namespace
}  // namespace rayshade
