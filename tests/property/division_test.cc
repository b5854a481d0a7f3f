// Memory divides: whatever the objects and wherever they are, no voxel has much more than its portion of them, and not much is
// held more than once.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "rayshade/space/bintree.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

constexpr double kMost = 1.3;  // of a portion, and of all together

// Boxes as scenes have them: spread out, in one corner of a floor, in clusters of clusters, in a mesh; of like or unlike size.
std::vector<HeldBox> randomObjects(SeededRandom& random, int count) {
  std::vector<HeldBox> objects;
  const int kind = random.integer(0, 3);
  const bool uneven = random.oneIn(2);
  const double spread = std::pow(10, random.real(-6, 0)), shift = random.oneIn(3) ? 1e3 : 0;
  const double side = spread / std::cbrt(count);
  if (kind == 1) objects.push_back({{{-12, -12, -1}, {12, 12, -1}}, 100, 1});
  const int columns = static_cast<int>(std::sqrt(count));
  for (int i = 0; i < count; ++i) {
    Vec3 at = random.point(0, spread);
    double size = 0.3 * side * random.real(0.1, 1);
    if (kind == 2) {
      at = {};
      for (double scale = spread; scale > 0.1 * side; scale /= 4)
        at = at + scale * Vec3{double(random.integer(0, 2)), double(random.integer(0, 2)), random.real(0, 1)};
    }
    if (kind == 3) {
      size = spread / columns;
      at = {(i % columns) * size, (i / columns) * size, 0.1 * random.real(0, spread)};
    }
    at = at + Vec3{shift, 0, 0};
    objects.push_back(
        {padded({at, at + Vec3{size, size, size}}), uneven ? 100 + 1e3 * random.real() : 120, 1});
  }
  return objects;
}

struct Held {
  std::vector<double> bytes, objects;  // by voxel
};
Held heldBy(const BinTree& tree, const std::vector<HeldBox>& objects) {
  Held held{std::vector<double>(voxelCount(tree)), std::vector<double>(voxelCount(tree))};
  std::vector<VoxelId> voxels;
  for (const HeldBox& object : objects) {
    voxels.clear();
    voxelsTouching(tree, object.box, voxels);
    for (const VoxelId voxel : voxels) {
      held.bytes[number(voxel)] += object.bytes;
      held.objects[number(voxel)] += object.objects;
    }
  }
  return held;
}
double sum(const std::vector<double>& list) { return std::accumulate(list.begin(), list.end(), 0.0); }

Bounds worldOf(const std::vector<HeldBox>& objects) {
  Bounds world;
  for (const HeldBox& object : objects) world = join(world, object.box);
  return world;
}
BinTree divided(const std::vector<HeldBox>& objects, std::vector<Portion> portions,
                std::vector<CostBox> costs = {}) {
  DensityGrid none;
  return buildBalancedTree(worldOf(objects), 0, none, objects, std::move(costs), std::move(portions));
}

TEST(DividedMemory, NoVoxelHasMuchMoreThanItsPortion) {
  for (std::uint64_t seed = 0; seed < seedCount(60); ++seed) {
    SeededRandom random(seed);
    const auto voxels = static_cast<std::uint32_t>(random.pick({2, 3, 4, 7, 16, 64}));
    const std::vector<HeldBox> objects = randomObjects(random, 250 * static_cast<int>(voxels));
    std::vector<Portion> portions(voxels);
    if (random.oneIn(3))
      for (Portion& portion : portions) portion = {random.real(0.5, 2), random.real(0.5, 2)};
    std::vector<CostBox> costs;  // somewhere among the objects, all in one place
    if (random.oneIn(2)) costs.push_back({objects[objects.size() / 2].box, 1});
    const BinTree tree = divided(objects, portions, costs);
    ASSERT_EQ(voxelCount(tree), voxels);
    double bytes = 0, all = 0;
    for (const HeldBox& object : objects) bytes += object.bytes;
    for (const Portion& portion : portions) all += portion.bytes;
    const Held held = heldBy(tree, objects);
    for (std::uint32_t v = 0; v < voxels; ++v) {
      const double share = portions[v].bytes / all;
      EXPECT_LE(held.bytes[v], kMost * share * bytes) << v;
      EXPECT_LE(held.objects[v], kMost * share * static_cast<double>(objects.size())) << v;
    }
    EXPECT_LE(sum(held.bytes), kMost * bytes);
    EXPECT_LE(sum(held.objects), kMost * static_cast<double>(objects.size()));
  }
}

TEST(DividedMemory, WhatCannotBeSeparatedIsHeldOnce) {
  const Bounds unit{{0, 0, 0}, {1, 1, 1}};
  const std::vector<HeldBox> objects(500, {unit, 10, 1});
  for (const std::uint32_t voxels : {2u, 5u, 64u}) {
    const Held held = heldBy(divided(objects, std::vector<Portion>(voxels)), objects);
    EXPECT_EQ(sum(held.objects), 500);
  }
}

TEST(DividedMemory, NumbersThatSayNothingStillGiveEveryVoxel) {
  const double nan = std::nan("");
  const Bounds unit{{0, 0, 0}, {1, 1, 1}}, point{{5, 5, 5}, {5, 5, 5}};
  const std::vector<HeldBox> cases[] = {{},
                                        {{point, 1, 1}},
                                        {{point, 1, 1}, {point, 1, 1}},
                                        {{unit, 0, 0}},
                                        {{unit, nan, 1}},
                                        {{unit, kInfinity, 1}, {point, 1, 1}},
                                        {{{{nan, nan, nan}, {nan, nan, nan}}, 1, 1}},
                                        {{unit, 1, 1}, {{{1e300, 0, 0}, {1e300, 1, 1}}, 1, 1}}};
  for (const std::vector<HeldBox>& objects : cases)
    for (const std::uint32_t voxels : {1u, 7u, 1000u, kMaxVoxels})
      EXPECT_EQ(voxelCount(divided(objects, std::vector<Portion>(voxels))), voxels);
}

// Along x twice as many rays cross as along y: the cut is where they do not.
TEST(DividedMemory, OfEqualPlanesTheOneIsTakenThatFewRaysCross) {
  std::vector<HeldBox> objects;
  for (int i = 0; i < 400; ++i) {
    const Vec3 low{i % 20 * 1.0, i / 20 * 1.0, 0};
    objects.push_back({{low, low + Vec3{0.5, 0.5, 0.5}}, 1, 1});
  }
  std::vector<CostBox> costs;  // beams of work along x, between which there is room
  for (int beam = 0; beam < 8; ++beam)
    costs.push_back({{{0, beam * 2.5 + 0.1, 0}, {20, beam * 2.5 + 0.2, 1}}, 1});
  const BinTree tree = divided(objects, std::vector<Portion>(2), costs);
  EXPECT_EQ(tree.nodes[0].axis, 1);
}

}  // namespace
}  // namespace rayshade
