// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/bintree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

constexpr Bounds kUnit{{0, 0, 0}, {1, 1, 1}};

double volume(const Bounds& b, const Bounds& world) {
  double v = 1;
  for (int axis = 0; axis < 3; ++axis)
    v *= std::min(b.high[axis], world.high[axis]) - std::max(b.low[axis], world.low[axis]);
  return v;
}

DensityGrid cluster(int n) {
  DensityGrid grid;
  Random random(1);
  for (int i = 0; i < n; ++i) {
    Vec3 p = random.point(0, 1);
    p = {std::pow(p.x, 3), std::pow(p.y, 3), std::pow(p.z, 3)};
    grid.add({p, p});
  }
  return grid;
}

// Every id once, boxes that fit together, and half-open membership: a point is in exactly one cell.
void expectPartition(const BinTree& tree) {
  SeededRandom random(2);
  for (int i = 0; i < 50; ++i) {
    Vec3 p = random.point(-0.5, 1.5);
    if (i % 2 == 0)
      for (const BinNode& node : tree.nodes)
        if (!node.leaf() && random.oneIn(4)) p[node.axis] = node.split;
    int cells = 0, voxels = 0;
    const auto inside = [&](const Bounds& b) {
      return b.low.x <= p.x && p.x < b.high.x && b.low.y <= p.y && p.y < b.high.y && b.low.z <= p.z &&
             p.z < b.high.z;
    };
    for (std::uint32_t c = 0; c < cellCount(tree); ++c) cells += inside(boundsOf(tree, CellId{c}));
    for (std::uint32_t v = 0; v < voxelCount(tree); ++v) voxels += inside(boundsOf(tree, VoxelId{v}));
    EXPECT_EQ(cells, 1);
    EXPECT_EQ(voxels, 1);
  }
}

TEST(BinTree, AtFirstIsAllOfSpaceInOneVoxelOfOneCell) {
  const BinTree tree;
  EXPECT_EQ(cellCount(tree), 1u);
  EXPECT_EQ(voxelCount(tree), 1u);
  EXPECT_EQ(boundsOf(tree, CellId{0}), kEverywhere);
  EXPECT_EQ(boundsOf(tree, VoxelId{0}), kEverywhere);
  EXPECT_EQ(voxelOfCell(tree, CellId{0}), VoxelId{0});
  EXPECT_EQ(firstCellOfVoxel(tree, VoxelId{0}), CellId{0});
}

TEST(BinTree, CutsTheWorldIntoAnyNumberOfEqualVoxels) {
  const Bounds world{{-1, 2, 5}, {9, 3.5, 8}};
  for (std::uint32_t n = 1; n <= 40; ++n) {
    const BinTree tree = buildBinTree(world, {.voxels = n});
    ASSERT_EQ(voxelCount(tree), n);
    ASSERT_EQ(cellCount(tree), n);
    for (std::uint32_t v = 0; v < n; ++v) {
      EXPECT_NEAR(volume(boundsOf(tree, VoxelId{v}), world), volume(world, world) / n, 1e-12);
      EXPECT_EQ(voxelOfCell(tree, CellId{v}), VoxelId{v});
    }
    expectPartition(tree);
  }
}

TEST(BinTree, CutsTheLongestSideFirst) {
  const BinTree tree = buildBinTree({{0, 0, 0}, {1, 8, 2}}, {.voxels = 2});
  EXPECT_EQ(boundsOf(tree, VoxelId{0}).high, (Vec3{kInfinity, 4, kInfinity}));
  EXPECT_EQ(boundsOf(tree, VoxelId{1}).low, (Vec3{-kInfinity, 4, -kInfinity}));
}

// Hard case D8, and worlds that are no box at all.
TEST(BinTree, CutsFlatThinEmptyAndInfiniteWorlds) {
  const Bounds worlds[] = {{{0, 0, 5}, {3, 2, 5}},
                           {{0, 7, 5}, {3, 7, 5}},
                           {{4, 7, 5}, {4, 7, 5}},
                           {{0, 0, 0}, {0, 0, 0}},
                           {{1e300, 0, 0}, {1e300, 0, 0}},
                           {{1e-310, 0, 0}, {1e-310, 0, 0}},
                           {{-1.7e308, 0, 0}, {1.7e308, 1, 1}},
                           {{1, 1, 1}, {std::nextafter(1, 2), 1, 1}},
                           Bounds{},
                           kEverywhere,
                           {{std::nan(""), 0, 0}, {1, 1, 1}}};
  for (const Bounds& world : worlds)
    for (const std::uint32_t n : {1u, 2u, 7u, 64u, 1000u})
      EXPECT_EQ(voxelCount(buildBinTree(world, {.voxels = n})), n) << world.low.x;
  const BinTree flat = buildBinTree(worlds[0], {.voxels = 64});
  for (const BinNode& node : flat.nodes) EXPECT_NE(node.axis, 2);  // one cell in z
}

TEST(BinTree, NumbersOfVoxelsAreClampedToTheirRange) {
  EXPECT_EQ(voxelCount(buildBinTree(kUnit, {.voxels = 0})), 1u);
  EXPECT_EQ(voxelCount(buildBinTree({{5, 5, 5}, {5, 5, 5}}, {.voxels = 0xffffffffu})), kMaxVoxels);
}

TEST(BinTree, CellsBalanceTheObjectsAndLieInTheirVoxels) {
  DensityGrid grid = cluster(20000);
  const BinTree tree = buildBinTree(kUnit, {.voxels = 6, .cells = 100}, grid);
  EXPECT_EQ(voxelCount(tree), 6u);
  EXPECT_GE(cellCount(tree), 100u);
  EXPECT_LE(cellCount(tree), 206u);
  std::vector<std::uint32_t> counts(cellCount(tree));
  for (const DensityGrid::Cube& c : grid.cubes()) {
    const Vec3 p = Vec3{c.x + 0.5, c.y + 0.5, c.z + 0.5} * grid.side();
    std::vector<CellId> at;
    cellsTouching(tree, {p, p}, at);
    ASSERT_FALSE(at.empty());
    counts[number(at.back())] += c.count;
  }
  EXPECT_LE(*std::max_element(counts.begin(), counts.end()), 200u);
  std::uint32_t next = 0;
  for (std::uint32_t v = 0; v < 6; ++v) {
    EXPECT_EQ(firstCellOfVoxel(tree, VoxelId{v}), CellId{next});
    const Bounds voxel = boundsOf(tree, VoxelId{v});
    for (; next < cellCount(tree) && voxelOfCell(tree, CellId{next}) == VoxelId{v}; ++next)
      EXPECT_EQ(join(voxel, boundsOf(tree, CellId{next})), voxel);
  }
  EXPECT_EQ(next, cellCount(tree));
  expectPartition(tree);
}

TEST(BinTree, CellsLeaveTheVoxelsAsTheyAre) {
  DensityGrid grid = cluster(5000);
  const BinTree coarse = buildBinTree(kUnit, {.voxels = 7});
  const BinTree fine = buildBinTree(kUnit, {.voxels = 7, .cells = 60}, grid);
  for (std::uint32_t v = 0; v < 7; ++v) EXPECT_EQ(boundsOf(coarse, VoxelId{v}), boundsOf(fine, VoxelId{v}));
}

// How much of the costs lies in each voxel.
std::vector<double> costsOf(const BinTree& tree, const std::vector<CostBox>& costs) {
  std::vector<double> sums;
  for (std::uint32_t v = 0; v < voxelCount(tree); ++v) {
    const Bounds voxel = boundsOf(tree, VoxelId{v});
    double sum = 0;
    for (const CostBox& c : costs)
      if (overlap(voxel, c.box)) sum += c.cost * volume(voxel, c.box) / volume(c.box, c.box);
    sums.push_back(sum);
  }
  return sums;
}

TEST(BinTree, VoxelsOfEqualCostShareOutTheCosts) {
  std::vector<CostBox> costs;  // most of it near a corner
  for (int i = 0; i < 512; ++i) {
    const Vec3 low{i % 8 / 8.0, i / 8 % 8 / 8.0, i / 64 / 8.0};
    costs.push_back({{low, low + Vec3{0.125, 0.125, 0.125}}, std::exp(-6 * (low.x + low.y + low.z))});
  }
  double all = 0;
  for (const CostBox& c : costs) all += c.cost;
  for (const std::uint32_t n : {2u, 3u, 8u, 13u}) {
    DensityGrid none;
    const BinTree tree = buildBinTree(kUnit, {.voxels = n}, none, costs);
    ASSERT_EQ(voxelCount(tree), n);
    for (const double cost : costsOf(tree, costs)) EXPECT_NEAR(cost, all / n, 0.02 * all / n) << n;
    expectPartition(tree);
    // Cut into equal voxels, one of them has most of it.
    const std::vector<double> equal = costsOf(buildBinTree(kUnit, {.voxels = n}), costs);
    EXPECT_GT(*std::max_element(equal.begin(), equal.end()), 1.5 * all / n);
  }
}

TEST(BinTree, CostsThatCannotBeSharedOutStillGiveEveryVoxel) {
  const double nan = std::nan("");
  const Bounds corner{{0, 0, 0}, {0x1p-40, 0x1p-40, 0x1p-40}};
  const std::vector<CostBox> cases[] = {{{corner, 1}},
                                        {{{{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}}, 1}},
                                        {{kUnit, nan}},
                                        {{kUnit, kInfinity}},
                                        {{kUnit, 0}},
                                        {{kUnit, -1}},
                                        {{{{nan, nan, nan}, {nan, nan, nan}}, 1}},
                                        {{{{5, 5, 5}, {6, 6, 6}}, 1}}};
  for (const std::vector<CostBox>& costs : cases)
    for (const std::uint32_t n : {1u, 7u, 1000u, kMaxVoxels}) {
      DensityGrid none;
      EXPECT_EQ(voxelCount(buildBinTree(kUnit, {.voxels = n}, none, costs)), n);
      const Bounds line{{1, 1, 1}, {1 + 0x1p-23, 1, 1}};
      EXPECT_EQ(voxelCount(buildBinTree(line, {.voxels = n}, none, costs)), n);
    }
}

// Hard case D18: nothing can separate them, so nothing is cut.
TEST(BinTree, CoincidentObjectsMakeNoCells) {
  DensityGrid grid;
  for (int i = 0; i < 1000; ++i) grid.add(kUnit);
  EXPECT_EQ(cellCount(buildBinTree(kUnit, {.voxels = 1, .cells = 500}, grid)), 1u);
}

// Hard case D15.
TEST(BinTree, BoundsThatTouchAPlaneAreOnBothSides) {
  const BinTree tree = buildBinTree(kUnit, {.voxels = 2});
  const auto touching = [&](double low, double high) {
    std::vector<VoxelId> found;
    voxelsTouching(tree, {{low, 0, 0}, {high, 1, 1}}, found);
    return found;
  };
  const std::vector<VoxelId> both{VoxelId{0}, VoxelId{1}};
  EXPECT_EQ(touching(0.25, 0.5), both);
  EXPECT_EQ(touching(0.5, 0.75), both);
  EXPECT_EQ(touching(0.5, 0.5), both);
  EXPECT_EQ(touching(0.25, std::nextafter(0.5, 0)), std::vector<VoxelId>{VoxelId{0}});
  EXPECT_EQ(touching(std::nextafter(0.5, 1), 0.75), std::vector<VoxelId>{VoxelId{1}});
  EXPECT_EQ(touching(-kInfinity, kInfinity), both);
  EXPECT_EQ(touching(std::nan(""), std::nan("")), both);
  EXPECT_TRUE(touching(kInfinity, -kInfinity).empty());
}

TEST(BinTree, TouchingAppendsEveryCellThatOverlapsAndNoOther) {
  DensityGrid grid = cluster(3000);
  const BinTree tree = buildBinTree(kUnit, {.voxels = 5, .cells = 50}, grid);
  SeededRandom random(3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 low = random.point(0, 1);
    const Bounds bounds{low, low + random.point(0, 0.3)};
    std::vector<CellId> cells{CellId{77}}, expectedCells{CellId{77}};
    std::vector<VoxelId> voxels, expectedVoxels;
    cellsTouching(tree, bounds, cells);
    voxelsTouching(tree, bounds, voxels);
    for (std::uint32_t c = 0; c < cellCount(tree); ++c)
      if (overlap(boundsOf(tree, CellId{c}), bounds)) expectedCells.push_back(CellId{c});
    for (std::uint32_t v = 0; v < voxelCount(tree); ++v)
      if (overlap(boundsOf(tree, VoxelId{v}), bounds)) expectedVoxels.push_back(VoxelId{v});
    EXPECT_EQ(cells, expectedCells);
    EXPECT_EQ(voxels, expectedVoxels);
  }
}

// Hard case D16: 3 * 0.1 > 0.3, but a border is the same number for both of its neighbours, at home and after
// a journey.
TEST(BinTree, NeighboursShareTheirBorderBitForBitAfterTheWire) {
  const BinTree tree = buildBinTree({{0, 0, 0}, {1, 0.05, 0.05}}, {.voxels = 10});
  const auto received = decode<BinTree>(encode(tree));
  ASSERT_TRUE(received.has_value());
  EXPECT_EQ(encode(*received), encode(tree));
  for (std::uint32_t v = 0; v + 1 < 10; ++v) {
    EXPECT_EQ(boundsOf(tree, VoxelId{v}).high.x, boundsOf(tree, VoxelId{v + 1}).low.x);
    EXPECT_EQ(boundsOf(tree, VoxelId{v}), boundsOf(*received, VoxelId{v}));
  }
}

TEST(BinTree, TheWireKeepsVoxelsAndCells) {
  DensityGrid grid = cluster(3000);
  const BinTree tree = buildBinTree(kUnit, {.voxels = 5, .cells = 50}, grid);
  const auto received = decode<BinTree>(encode(tree));
  ASSERT_TRUE(received.has_value());
  EXPECT_EQ(received->cellNodes, tree.cellNodes);
  EXPECT_EQ(received->voxelNodes, tree.voxelNodes);
}

TEST(BinTree, RefusesCodesThatAreNoTree) {
  const double inf = kInfinity, nan = std::nan("");
  const TreeCode good{{0, 7, 5, 3, 3}, {1, 2}};  // x = 1: a voxel; another, cut at y = 2
  ASSERT_TRUE(treeFrom(good).has_value());
  const TreeCode bad[] = {
      {{}, {}},                   // nothing
      {{3}, {}},                  // a cell of no voxel
      {{8}, {}},                  // no such kind
      {{0, 7}, {1}},              // a child is missing
      {{0, 7, 7, 7}, {1}},        // a node too many
      {{7, 0, 7, 7, 7}, {1, 2}},  // nodes after the end
      {{0, 7, 7}, {}},            // a plane is missing
      {{0, 7, 7}, {1, 2}},        // a plane too many
      {{4, 7, 3}, {1}},           // a voxel in a voxel
      {{0, 7, 3}, {1}},           // a cell of no voxel
      {{0, 7, 7}, {inf}},         // planes nowhere
      {{0, 7, 7}, {nan}},         //
      {{0, 7, 0, 7, 7}, {1, 1}},  // a cut outside of what it cuts
      {{0, 0, 7, 7, 7}, {1, 2}},  //
  };
  for (const TreeCode& code : bad) EXPECT_FALSE(treeFrom(code).has_value());
}

TEST(BinTree, RefusesTreesThatAreTooDeep) {
  const auto chain = [](int depth) {
    TreeCode code;
    for (int i = 0; i < depth; ++i) {
      code.kinds.insert(code.kinds.end(), {0, 7});
      code.splits.push_back(i);
    }
    code.kinds.push_back(7);
    return code;
  };
  EXPECT_TRUE(treeFrom(chain(kMaxTreeDepth)).has_value());
  EXPECT_FALSE(treeFrom(chain(kMaxTreeDepth + 1)).has_value());
}

TEST(BinTree, DamagedMessagesAreRefusedOrAreTrees) {
  DensityGrid grid = cluster(500);
  const Bytes bytes = encode(buildBinTree(kUnit, {.voxels = 3, .cells = 9}, grid));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_FALSE(decode<BinTree>(std::span(bytes).first(i)).has_value());
    for (const int flip : {1, 2, 4, 0x80}) {
      Bytes damaged = bytes;
      damaged[i] ^= std::byte(flip);
      const auto tree = decode<BinTree>(damaged);
      EXPECT_TRUE(!tree || encode(*tree) == damaged);
    }
  }
}

}  // namespace
}  // namespace rayshade
