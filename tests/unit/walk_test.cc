// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/walk.h"

#include <gtest/gtest.h>

namespace rayshade {
namespace {

template <class Id = VoxelId>
std::vector<WalkStep<Id>> steps(const BinTree& tree, Vec3 origin, Vec3 direction) {
  std::vector<WalkStep<Id>> list;
  Walk<Id> walk(tree, origin, direction);
  for (WalkStep<Id> step; walk.next(step);) list.push_back(step);
  return list;
}

std::vector<std::uint32_t> numbers(const BinTree& tree, Vec3 origin, Vec3 direction) {
  std::vector<std::uint32_t> list;
  for (const auto& step : steps(tree, origin, direction)) list.push_back(number(step.where));
  return list;
}

using Numbers = std::vector<std::uint32_t>;

// n voxels side by side along x, cut at 1, 2, ... n - 1.
BinTree row(int n) {
  TreeCode code;
  for (int i = 1; i < n; ++i) {
    code.kinds.insert(code.kinds.end(), {0, 7});
    code.splits.push_back(i);
  }
  code.kinds.push_back(7);
  return treeFrom(code).value();
}

TEST(Walk, OfOneVoxelIsOneEndlessStep) {
  const auto list = steps(BinTree{}, {1, 2, 3}, {1, 0, 0});
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0], (WalkStep<VoxelId>{VoxelId{0}, 0, kInfinity}));
}

TEST(Walk, GoesThroughVoxelsInOrderAndTheIntervalsMeet) {
  const auto list = steps(row(4), {-1, 0, 0}, {0.5, 0, 0});
  ASSERT_EQ(list.size(), 4u);
  EXPECT_EQ(list[0], (WalkStep<VoxelId>{VoxelId{0}, 0, 4}));
  EXPECT_EQ(list[1], (WalkStep<VoxelId>{VoxelId{1}, 4, 6}));
  EXPECT_EQ(list[2], (WalkStep<VoxelId>{VoxelId{2}, 6, 8}));
  EXPECT_EQ(list[3], (WalkStep<VoxelId>{VoxelId{3}, 8, kInfinity}));
  EXPECT_EQ(numbers(row(4), {10, 0, 0}, {-1, 0, 0}), (Numbers{3, 2, 1, 0}));
  EXPECT_EQ(numbers(row(4), {1.5, 0, 0}, {-1, 0, 0}), (Numbers{1, 0}));
}

TEST(Walk, StopsAtVoxelsOrAtCells) {
  const BinTree tree = treeFrom({{4, 3, 0, 3, 3}, {1, 2}}).value();
  EXPECT_EQ(steps<VoxelId>(tree, {0, 0, 0}, {1, 0, 0}).size(), 1u);
  const auto cells = steps<CellId>(tree, {0, 0, 0}, {1, 0, 0});
  ASSERT_EQ(cells.size(), 3u);
  EXPECT_EQ(cells[2], (WalkStep<CellId>{CellId{2}, 2, kInfinity}));
}

// Hard case D1: traced once, in the voxel that begins at the face.
TEST(Walk, ARayInAFaceIsInTheVoxelAboveIt) {
  for (const double zero : {0.0, -0.0}) EXPECT_EQ(numbers(row(3), {1, -5, 0}, {zero, 1, zero}), (Numbers{1}));
}

// Hard case D2.
TEST(Walk, TheDiagonalOfTenByTenByTenVoxelsIsCrossedInOrder) {
  const BinTree tree = buildBinTree({{0, 0, 0}, {8, 8, 8}}, {.voxels = 512});
  for (const double sign : {1.0, -1.0}) {
    const double start = sign > 0 ? -1.0 : 9.0;
    const auto list = steps(tree, {start, start, start}, {sign, sign, sign});
    ASSERT_EQ(list.size(), 8u);  // corner to corner: no voxel that is only touched
    for (std::uint32_t i = 0; i < 8; ++i) {
      const double low = sign > 0 ? i : 7 - i;
      const Bounds box = boundsOf(tree, list[i].where);
      EXPECT_TRUE(contains(box, {low + 0.5, low + 0.5, low + 0.5}));
    }
  }
  // Ten per side, whose borders are no exact numbers: a corner may be three crossings an ulp apart.
  const BinTree tenth = buildBinTree({{0, 0, 0}, {1, 1, 1}}, {.voxels = 1000});
  const auto list = steps(tenth, {-0.5, -0.5, -0.5}, {1, 1, 1});
  EXPECT_LE(list.size(), 1000u);
  for (int i = 0; i < 100; ++i) {
    const double at = (i + 0.5) / 100;
    int owners = 0;
    for (const auto& step : list)
      if (step.tEnter <= at + 0.5 && at + 0.5 < step.tExit) {
        ++owners;
        EXPECT_TRUE(contains(boundsOf(tenth, step.where), {at, at, at}));
      }
    EXPECT_EQ(owners, 1);
  }
}

// Hard case D3.
TEST(Walk, ZerosOfBothSignsCrossNothing) {
  const BinTree tree = buildBinTree({{0, 0, 0}, {2, 2, 2}}, {.voxels = 8});
  for (const double a : {0.0, -0.0})
    for (const double b : {0.0, -0.0}) {
      const auto list = steps(tree, {0.5, 1, 1}, {1, a, b});
      ASSERT_EQ(list.size(), 2u);
      EXPECT_EQ(boundsOf(tree, list[0].where).low, (Vec3{-kInfinity, 1, 1}));
      EXPECT_EQ(list[0].tExit, 0.5);
    }
}

// Hard case D4: nearly parallel is not parallel.
TEST(Walk, AGrazingRayCrossesThePlaneItReaches) {
  const BinTree tree = treeFrom({{1, 7, 7}, {5}}).value();
  const auto list = steps(tree, {0, 0, 0}, {1, 9e-6, 0});
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].tExit, 5 / 9e-6);
}

// Hard cases D5 and D6: the hit at t = 3 on the face belongs to the second voxel, and to it alone.
TEST(Walk, AHitOnAFaceBelongsToTheVoxelThatBeginsThere) {
  for (const double direction : {1.0, -1.0}) {
    int owners = 0;
    for (const auto& step : steps(row(2), {1 - 3 * direction, 0, 0}, {direction, 0, 0}))
      if (step.tEnter <= 3 && 3 < step.tExit) {
        ++owners;
        EXPECT_EQ(number(step.where), direction > 0 ? 1u : 0u);
      }
    EXPECT_EQ(owners, 1);
  }
}

// Hard case D7.
TEST(Walk, FromAFaceTheFirstVoxelIsTheOneTheRayGoesTo) {
  EXPECT_EQ(numbers(row(3), {1, 0, 0}, {1, 0, 0}), (Numbers{1, 2}));
  EXPECT_EQ(numbers(row(3), {1, 0, 0}, {-1, 0, 0}), (Numbers{0}));
  EXPECT_EQ(numbers(row(3), {1, 0, 0}, {1e-300, 1, 0}), (Numbers{1, 2}));
  EXPECT_EQ(numbers(row(3), {1, 0, 0}, {-1e-300, 1, 0}), (Numbers{0}));
  EXPECT_EQ(numbers(row(3), {1, 0, 0}, {0, 1, 0}), (Numbers{1}));
}

// Hard case D10: no border is the sum of the ones before it.
TEST(Walk, EveryBorderIsComputedAfresh) {
  constexpr std::uint32_t kVoxels = kMaxVoxels;
  const BinTree tree = buildBinTree({{0, 0, 0}, {0.1 * kVoxels, 1e-9, 1e-9}}, {.voxels = kVoxels});
  const double origin = -0.3, direction = 0.7;
  VoxelWalk walk(tree, {origin, 0, 0}, {direction, 0, 0});
  std::uint32_t expected = 0;
  for (WalkStep<VoxelId> step; walk.next(step); ++expected) {
    ASSERT_EQ(number(step.where), expected);
    const double border = boundsOf(tree, step.where).high.x;
    ASSERT_EQ(step.tExit, expected + 1 < kVoxels ? (border - origin) / direction : kInfinity);
  }
  EXPECT_EQ(expected, kVoxels);
}

// Hard case D11.
TEST(Walk, FromVeryFarTheRayEntersTheRightVoxel) {
  const BinTree tree = buildBinTree({{0, 0, 0}, {4, 4, 4}}, {.voxels = 64});
  const auto list = steps(tree, {-1e12, 1.5, 2.5}, {1, 0, 0});
  ASSERT_EQ(list.size(), 4u);
  for (std::uint32_t i = 0; i < 4; ++i)
    EXPECT_TRUE(contains(boundsOf(tree, list[i].where), {i + 0.5, 1.5, 2.5}));
  EXPECT_EQ(list[0].tExit, 1e12 + 1);
}

TEST(Walk, APositionOnTheWalkIsAnInteger) {
  const BinTree tree = buildBinTree({{0, 0, 0}, {4, 4, 4}}, {.voxels = 27});
  const Vec3 origin{-1, 0.3, 0.2}, direction{0.8, 0.48, 0.36};
  const auto list = steps(tree, origin, direction);
  for (std::uint32_t i = 0; i < list.size(); ++i)
    EXPECT_EQ(stepAt<VoxelId>(tree, origin, direction, i), list[i]);
  EXPECT_EQ(stepAt<VoxelId>(tree, origin, direction, static_cast<std::uint32_t>(list.size())), std::nullopt);
  EXPECT_EQ(stepAt<VoxelId>(tree, origin, direction, 0xffffffffu), std::nullopt);
}

// Hard case F8.
TEST(Walk, RaysThatAreNoNumbersWalkSomewhereAndEnd) {
  const BinTree tree = buildBinTree({{0, 0, 0}, {4, 4, 4}}, {.voxels = 64});
  const double odd[] = {std::nan(""), kInfinity, -kInfinity, 0.0, 1e308, -1e308, 5e-324};
  for (const double a : odd)
    for (const double b : odd)
      for (const double c : odd) {
        const auto list = steps(tree, {a, b, 1}, {c, b, 1});
        ASSERT_GE(list.size(), 1u);
        ASSERT_LE(list.size(), 64u);
        EXPECT_EQ(list.back().tExit, kInfinity);
      }
}

// The quotient underflows to 0, the plane is crossed all the same.
TEST(Walk, APlaneADenormalAwayIsCrossed) {
  const BinTree tree = treeFrom({{0, 7, 7}, {0}}).value();
  EXPECT_EQ(numbers(tree, {-5e-324, 0, 0}, {8, 0, 0}).back(), 1u);
}

TEST(Walk, AScaleByAPowerOfTwoScalesTheBordersExactly) {
  const Bounds world{{-1, -2, 0.3}, {3.7, 2.1, 4}};
  const BinTree one = buildBinTree(world, {.voxels = 30});
  const BinTree other = buildBinTree({world.low * 0x1p-20, world.high * 0x1p-20}, {.voxels = 30});
  const Vec3 origin{-3, 0.1, 0.2}, direction = normalize({1, 0.3, 0.45});
  const auto a = steps(one, origin, direction), b = steps(other, origin * 0x1p-20, direction);
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GE(a.size(), 3u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].where, b[i].where);
    EXPECT_EQ(a[i].tExit * 0x1p-20, b[i].tExit);
  }
}

}  // namespace
}  // namespace rayshade
