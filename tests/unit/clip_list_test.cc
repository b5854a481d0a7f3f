// The cells that a pyramid may touch: none forgotten, near to far, whatever lies on a border.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/clip_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "rayshade/space/walk.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

// A box of side 4 at the origin in 64 unit cells; those on its border reach to infinity.
BinTree unitCells() { return buildBinTree({{0, 0, 0}, {4, 4, 4}}, TreeLimits{64}); }

BinTree randomTree(Random& random) {
  DensityGrid density;
  Bounds world;
  for (int i = random.integer(20, 300); i > 0; --i) {
    const Vec3 low = random.point(-8, 8);
    const Bounds box{low, low + random.point(0, 1)};
    world = join(world, box);
    density.add(box);
  }
  const auto voxels = static_cast<std::uint32_t>(random.integer(1, 8));
  const auto cells = static_cast<std::uint32_t>(random.integer(8, 80));
  return buildBinTree(world, {voxels, cells}, density);
}

std::array<Vec3, 4> corners(Random& random, Vec3 axis, double width) {
  const Basis across = basisAround(normalize(axis));
  const Vec3 u = width * across.first, v = width * random.real(0.1, 1) * across.second, d = normalize(axis);
  return {d - u - v, d + u - v, d + u + v, d - u + v};
}
// A direction between four corners that lie in a plane; on the sides and the edges, too.
Vec3 between(Random& random, const std::array<Vec3, 4>& c) {
  auto share = [&] { return std::clamp(random.real(-0.2, 1.2), 0.0, 1.0); };
  const double u = share(), v = share();
  return normalize((c[0] * (1 - u) + c[1] * u) * (1 - v) + (c[3] * (1 - u) + c[2] * u) * v);
}

std::vector<CellId> walked(const BinTree& tree, Vec3 origin, Vec3 direction) {
  std::vector<CellId> cells;
  CellWalk walk(tree, origin, direction);
  for (WalkStep<CellId> step; walk.next(step);) cells.push_back(step.where);
  return cells;
}
bool lists(const std::vector<CellId>& list, CellId cell) {
  return std::find(list.begin(), list.end(), cell) != list.end();
}
bool isSubsequence(const std::vector<CellId>& part, const std::vector<CellId>& whole) {
  auto at = whole.begin();
  for (CellId cell : part) {
    at = std::find(at, whole.end(), cell);
    if (at == whole.end()) return false;
    ++at;
  }
  return true;
}
// The cell of a point, by the half-open rule.
CellId cellAt(const BinTree& tree, Vec3 p) {
  std::uint32_t node = 0;
  while (!tree.nodes[node].leaf())
    node = p[tree.nodes[node].axis] < tree.nodes[node].split ? node + 1 : tree.nodes[node].high;
  return CellId{tree.nodes[node].high};
}

TEST(ClipList, EveryWalkOfARayInThePyramidIsASubsequence) {
  int rays = 0;
  std::size_t listed = 0, all = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    SeededRandom random(seed);
    const BinTree tree = randomTree(random);
    const Vec3 apex = random.point(-12, 12);
    const auto around = corners(random, random.point(-1, 1), random.real(0, 1) * random.real(0, 3));
    const auto list = clipList(tree, pyramidOf(apex, around));
    EXPECT_EQ(std::set<CellId>(list.begin(), list.end()).size(), list.size()) << "no cell twice";
    listed += list.size();
    all += cellCount(tree);
    for (int i = 0; i < 100; ++i, ++rays)
      ASSERT_TRUE(isSubsequence(walked(tree, apex, between(random, around)), list))
          << "seed " << seed << " ray " << i;
  }
  EXPECT_EQ(rays, 15000);
  EXPECT_LT(listed, all / 2) << "a list of everything would be right and useless";
}

// An apex on a plane that cuts space: some ray may be ordered otherwise, none finds a cell that is not listed.
TEST(ClipList, FromAnApexOnACuttingPlaneNoCellIsForgotten) {
  const BinTree tree = unitCells();
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SeededRandom random(seed);
    Vec3 apex = random.point(-1, 5);
    for (int axis = 0; axis < 3; ++axis)
      if (random.integer(0, 1) == 0) apex[axis] = random.integer(0, 4);
    auto around = corners(random, random.point(-1, 1), random.real(0, 2));
    if (random.integer(0, 1) == 0) {  // with sides in the planes, too
      const double x = random.integer(-1, 1);
      around = {Vec3{x, 1, 0}, Vec3{x, 1, 1}, Vec3{x, 0, 1}, Vec3{x + 1, 0, 0}};
    }
    const auto list = clipList(tree, pyramidOf(apex, around));
    for (int i = 0; i < 50; ++i)
      for (CellId cell : walked(tree, apex, between(random, around)))
        ASSERT_TRUE(lists(list, cell)) << "seed " << seed;
  }
}

TEST(ClipList, TheCellOfTheApexComesFirst) {
  const BinTree tree = unitCells();
  const Vec3 apexes[] = {{1.5, 2.5, 1.5}, {2, 1.5, 1.5}, {2, 2, 1.5}, {2, 2, 2}, {0, 0, 0}, {-7, 2, 9}};
  SeededRandom random(1);
  for (const Vec3& apex : apexes)
    for (int i = 0; i < 50; ++i) {
      const auto list = clipList(tree, pyramidOf(apex, corners(random, random.point(-1, 1), 0.3)));
      ASSERT_FALSE(list.empty());
      EXPECT_EQ(list.front(), cellAt(tree, apex));
    }
}

// The sides of this pyramid are |y| + |z| = x + 1; the cell [1,2] x [1,2] x [2,3] has nothing of it but the corner (2,1,2).
TEST(ClipList, ACellThatIsTouchedAtACornerIsListed) {
  const BinTree tree = unitCells();
  const std::array<Vec3, 4> diamond{Vec3{1, 1, 0}, Vec3{1, 0, 1}, Vec3{1, -1, 0}, Vec3{1, 0, -1}};
  const auto list = clipList(tree, pyramidOf({-1, 0, 0}, diamond));
  const CellId touched = cellAt(tree, {1.5, 1.5, 2.5});
  ASSERT_EQ(boundsOf(tree, touched), (Bounds{{1, 1, 2}, {2, 2, 3}}));
  EXPECT_TRUE(lists(list, touched));
  // Moved away by a millionth it is not.
  EXPECT_FALSE(lists(clipList(tree, pyramidOf({-1, -1e-6, 0}, diamond)), touched));
}

TEST(ClipList, NothingBehindTheEyeIsListed) {
  const BinTree tree = unitCells();
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SeededRandom random(seed);
    const Vec3 apex = random.point(0, 4);
    const Pyramid pyramid = pyramidOf(apex, corners(random, random.point(-1, 1), 0.5));
    for (CellId cell : clipList(tree, pyramid)) {
      const Bounds box = boundsOf(tree, cell);
      if (!box.finite()) continue;
      Vec3 foremost;
      for (int axis = 0; axis < 3; ++axis)
        foremost[axis] = pyramid.axis[axis] > 0 ? box.high[axis] : box.low[axis];
      EXPECT_GE(dot(foremost - apex, pyramid.axis), -1e-11);
    }
  }
}

// Of cells that lie in front of the eye: beside it a thin pyramid is less exact than a wide one.
TEST(ClipList, TheListsOfTilesAreInTheListOfThePicture) {
  std::size_t found = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SeededRandom random(seed);
    const BinTree tree = randomTree(random);
    const Vec3 apex = random.point(-12, 12);
    const auto whole = corners(random, -1 * apex, 0.5);
    const Vec3 right = (whole[1] - whole[0]) / 8, down = (whole[3] - whole[0]) / 8;
    const Pyramid picture = pyramidOf(apex, whole);
    const auto list = clipList(tree, picture);
    auto isBehind = [&](CellId cell) {
      const Bounds box = boundsOf(tree, cell);
      Vec3 hindmost;
      for (int axis = 0; axis < 3; ++axis)
        hindmost[axis] = picture.axis[axis] > 0 ? box.low[axis] : box.high[axis];
      return !box.finite() || dot(hindmost - apex, picture.axis) < 0;
    };
    for (int x = 0; x < 8; ++x)
      for (int y = 0; y < 8; ++y) {
        const Vec3 c = whole[0] + x * right + y * down;
        auto tile = clipList(tree, pyramidOf(apex, {c, c + right, c + right + down, c + down}));
        std::erase_if(tile, isBehind);
        found += tile.size();
        ASSERT_TRUE(isSubsequence(tile, list)) << "seed " << seed;
      }
  }
  EXPECT_GT(found, 1000u);
}

// One pixel of a large picture is 1600 units wide at a distance of a million.
TEST(ClipList, AThinPyramidWidensFarAway) {
  const BinTree tree = buildBinTree({{999990, -2000, -2000}, {1000010, 2000, 2000}}, TreeLimits{256});
  const double half = std::tan(45 * 3.14159265358979 / 360) / 512;
  const std::array<Vec3, 4> pixel{Vec3{1, -half, -half}, Vec3{1, half, -half}, Vec3{1, half, half},
                                  Vec3{1, -half, half}};
  const auto list = clipList(tree, pyramidOf({}, pixel));
  SeededRandom random(0);
  std::set<CellId> seen;
  for (int i = 0; i < 2000; ++i)
    for (CellId cell : walked(tree, {}, between(random, pixel))) {
      ASSERT_TRUE(lists(list, cell));
      seen.insert(cell);
    }
  EXPECT_GT(seen.size(), 20u) << "the rays do spread over many cells";
  EXPECT_LT(list.size(), 2 * seen.size()) << "and few are listed besides";
}

TEST(LightPyramid, NoOccluderIsForgottenHoweverNearTheLight) {
  const Vec3 corner{1, 1, 2}, u{2, 0, 0}, v{0, 2, 0};
  const BinTree tree = unitCells();
  for (const double distance : {1e-6, 1e-3, 0.5, 3.0, 100.0}) {
    SeededRandom random(7);
    const Vec3 apex{2.1, 1.7, 2 - distance};
    const auto list = clipList(tree, pyramidTo(apex, corner, u, v));
    for (int i = 0; i < 500; ++i) {
      const Vec3 to = corner + random.real(0, 1) * u + random.real(0, 1) * v;
      const auto cells = walked(tree, apex, normalize(to - apex));
      ASSERT_TRUE(isSubsequence(cells, list)) << distance;
    }
  }
}

TEST(LightPyramid, InThePlaneOfTheLightItIsASheet) {
  const BinTree tree = unitCells();
  const Vec3 corner{1.2, 1.2, 2.5}, u{1, 0, 0}, v{0, 1, 0};
  SeededRandom random(3);
  for (const Vec3& apex : {Vec3{-3, 1.5, 2.5}, Vec3{1.5, 1.5, 2.5}, corner, corner + u}) {
    const auto list = clipList(tree, pyramidTo(apex, corner, u, v));
    EXPECT_LE(list.size(), cellCount(tree));
    for (int i = 0; i < 200; ++i) {
      const Vec3 way = corner + random.real(0, 1) * u + random.real(0, 1) * v - apex;
      for (CellId cell : walked(tree, apex, normalize(way))) ASSERT_TRUE(lists(list, cell));
    }
  }
}

TEST(ClipList, CornersThatSpanNothingCutNothingOffInFront) {
  const BinTree tree = unitCells();
  const Vec3 same{1, 0.1, 0.2};
  for (const auto& around : {std::array<Vec3, 4>{same, same, same, same}, std::array<Vec3, 4>{},
                             std::array<Vec3, 4>{same, -same, same, -same},
                             std::array<Vec3, 4>{same, Vec3{std::nan(""), 0, 0}, same, same}}) {
    const auto list = clipList(tree, pyramidOf({2.5, 2.5, 2.5}, around));
    for (CellId cell : walked(tree, {2.5, 2.5, 2.5}, normalize(same))) EXPECT_TRUE(lists(list, cell));
  }
}

// As a receiver behind its cell would have it: the same list again, and the same for the same scene times 2^20.
TEST(ClipList, ScaledByAPowerOfTwoItIsTheSame) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SeededRandom random(seed);
    const Vec3 apex = random.point(-3, 7);
    const auto around = corners(random, random.point(-1, 1), 0.7);
    const auto list = clipList(unitCells(), pyramidOf(apex, around));
    for (const double scale : {0x1p-20, 0x1p+20}) {
      const BinTree tree = buildBinTree({{}, Vec3{4, 4, 4} * scale}, TreeLimits{64});
      EXPECT_EQ(clipList(tree, pyramidOf(apex * scale, around)), list) << seed;
    }
  }
}

}  // namespace
}  // namespace rayshade
