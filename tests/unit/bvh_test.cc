// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/accel/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

// The items of all leaves that a ray is offered.
std::set<std::uint32_t> offered(const Bvh& bvh, Vec3 origin, Vec3 direction, double tMin = 0,
                                double tMax = kInfinity) {
  std::set<std::uint32_t> found;
  bvh.nearest(origin, direction, tMin, tMax, [&](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t i = first; i < first + count; ++i) found.insert(bvh.order()[i]);
  });
  return found;
}

Bounds cube(Vec3 low, double size) { return {low, low + Vec3{size, size, size}}; }

std::vector<Bounds> row(int n) {
  std::vector<Bounds> items;
  for (int i = 0; i < n; ++i) items.push_back(cube({2.0 * i, 0, 0}, 1));
  return items;
}

TEST(Bvh, OfNothingOffersNothing) {
  EXPECT_TRUE(offered(Bvh(), {}, {1, 0, 0}).empty());
  EXPECT_TRUE(offered(Bvh(std::span<const Bounds>{}), {}, {1, 0, 0}).empty());
}

TEST(Bvh, OfOneItemOffersItOnlyWhereItIs) {
  const std::vector<Bounds> items{cube({1, 0, 0}, 1)};
  const Bvh bvh(items);
  EXPECT_EQ(offered(bvh, {0, 0.5, 0.5}, {1, 0, 0}).size(), 1u);
  EXPECT_EQ(offered(bvh, {0, 0.5, 0.5}, {-1, 0, 0}).size(), 0u);
  EXPECT_EQ(offered(bvh, {0, 1.5, 0.5}, {1, 0, 0}).size(), 0u);
}

TEST(Bvh, OrderIsAPermutationOfTheItems) {
  std::vector<Bounds> items = row(1000);
  items[17] = kEverywhere;
  items[500] = Bounds{};
  const Bvh bvh(items);
  std::vector<std::uint32_t> order(bvh.order().begin(), bvh.order().end());
  std::sort(order.begin(), order.end());
  ASSERT_EQ(order.size(), items.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
}

TEST(Bvh, IsTheSameForAnyNumberOfThreads) {
  SeededRandom random(3);
  std::vector<Bounds> items;
  for (int i = 0; i < 70000; ++i) {
    const Vec3 low = random.point(-1, 1);
    items.push_back({low, low + 0.01 * random.point(0, 1)});
  }
  items[5] = kEverywhere;
  items[40000] = Bounds{};
  const auto boundsOf = [&](std::uint32_t item) { return items[item]; };
  const BvhTree alone = buildBvh(items.size(), boundsOf, 1), together = buildBvh(items.size(), boundsOf, 3);
  EXPECT_EQ(alone.order, together.order);
  EXPECT_EQ(alone.root, together.root);
  ASSERT_EQ(alone.nodes.size(), together.nodes.size());
  for (std::size_t i = 0; i < alone.nodes.size(); ++i) {
    const BvhNode &one = alone.nodes[i], &other = together.nodes[i];
    ASSERT_EQ(std::memcmp(one.plane, other.plane, sizeof one.plane), 0) << i;
    ASSERT_EQ(std::memcmp(one.child, other.child, sizeof one.child), 0) << i;
  }
  EXPECT_EQ(alone.inTree + 2, items.size());
}

TEST(Bvh, UnboundedItemsAreOfferedToEveryRayAndEmptyOnesToNone) {
  std::vector<Bounds> items = row(10);
  items[3] = {{-kInfinity, -kInfinity, 0}, {kInfinity, kInfinity, 0}};
  items[4] = Bounds{};
  items[5].high.y = std::nan("");
  items[6] = {{-1e200, 0, 0}, {1e200, 1, 1}};
  EXPECT_EQ(offered(Bvh(items), {0, 50, 50}, {1, 0, 0}), (std::set<std::uint32_t>{3, 5, 6}));
}

TEST(Bvh, NearLeavesComeFirstAndFarOnesAreSkippedOnceTMaxIsLower) {
  const Bvh bvh(row(64));
  int visits = 0;
  double tMax = kInfinity;
  bvh.nearest({-1, 0.5, 0.5}, {1, 0, 0}, 0, tMax, [&](std::uint32_t first, std::uint32_t count) {
    ++visits;
    for (std::uint32_t i = first; i < first + count; ++i) tMax = std::min(tMax, 1 + 2.0 * bvh.order()[i]);
  });
  EXPECT_EQ(tMax, 1);
  EXPECT_LE(visits, 2);
}

TEST(Bvh, AnItemThatBeginsAtExactlyTMaxIsStillOffered) {
  const Bvh bvh(row(64));
  for (int i = 0; i < 64; ++i) {
    EXPECT_TRUE(offered(bvh, {-1, 0.5, 0.5}, {1, 0, 0}, 0, 1 + 2.0 * i).contains(i));
    EXPECT_TRUE(offered(bvh, {-1, 0.5, 0.5}, {1, 0, 0}, 2 + 2.0 * i).contains(i));
  }
}

TEST(Bvh, RaysBetweenTMinAndTMaxSeeLittleOfTheRest) {
  EXPECT_LE(offered(Bvh(row(64)), {-1, 0.5, 0.5}, {1, 0, 0}, 40.25, 41.25).size(), 4u);
}

TEST(Bvh, AnyStopsAtTheFirstTrue) {
  const Bvh bvh(row(64));
  int calls = 0;
  EXPECT_TRUE(bvh.any({-1, 0.5, 0.5}, {1, 0, 0}, 0, kInfinity, [&](std::uint32_t, std::uint32_t) {
    ++calls;
    return calls == 3;
  }));
  EXPECT_EQ(calls, 3);
  EXPECT_FALSE(
      bvh.any({-1, 0.5, 0.5}, {1, 0, 0}, 0, kInfinity, [](std::uint32_t, std::uint32_t) { return false; }));
}

// Hard case D3: zeros of both signs, the origin exactly on a slab.
TEST(Bvh, ZeroDirectionComponentsOnFacesEdgesAndCornersTouch) {
  const std::vector<Bounds> items{cube({0, 0, 0}, 1), cube({3, 3, 3}, 1)};
  const Bvh bvh(items);
  for (const double zero : {0.0, -0.0})
    for (const double y : {0.0, 0.5, 1.0})
      for (const double z : {-0.0, 0.5, 1.0})
        for (const double x : {-1.0, 0.0, 1.0}) {
          EXPECT_TRUE(offered(bvh, {x, y, z}, {1, zero, zero}).contains(0));
          EXPECT_TRUE(offered(bvh, {y, x, z}, {zero, 1, -zero}).contains(0));
          EXPECT_TRUE(offered(bvh, {1 - x, y, z}, {-1, zero, zero}).contains(0));
        }
  EXPECT_TRUE(offered(bvh, {-1, -0.001, 0.5}, {1, 0.0, -0.0}).empty());
}

TEST(Bvh, ADirectionOfLengthZeroTouchesWhatIsAtItsOrigin) {
  const Bvh bvh(row(64));
  EXPECT_EQ(offered(bvh, {4.5, 0.5, 0.5}, {0, 0, 0}).count(2), 1u);
  EXPECT_TRUE(offered(bvh, {4.5, 3, 0.5}, {0, -0.0, 0}).empty());
  EXPECT_EQ(offered(bvh, {4.5, 0.5, 0.5}, {0, 0, 0}, -kInfinity).count(2), 1u);
}

TEST(Bvh, RaysWithNanOrInfinityTouchNothingBounded) {
  const Bvh bvh(row(64));
  const double nan = std::nan("");
  EXPECT_TRUE(offered(bvh, {nan, 0, 0}, {1, 0, 0}).empty());
  EXPECT_TRUE(offered(bvh, {0, 0, 0}, {1, nan, 0}).empty());
  EXPECT_TRUE(offered(bvh, {0, 0, 0}, {kInfinity, 0, 0}).empty());
  EXPECT_TRUE(offered(bvh, {-kInfinity, 0, 0}, {1, 0, 0}).empty());
  EXPECT_TRUE(offered(bvh, {-1, 0.5, 0.5}, {1, 0, 0}, nan).empty());
  EXPECT_TRUE(offered(bvh, {-1, 0.5, 0.5}, {1, 0, 0}, 3, 2).empty());
}

// Hard case D4: a direction that is almost parallel to the faces still crosses many of them.
TEST(Bvh, AGrazingRayArrivesNineUnitsAside) {
  std::vector<Bounds> items;
  for (int i = 0; i <= 1000; ++i) items.push_back(cube({1e3 * i, 9e-3 * i, 0}, 1e-3));
  const Bvh bvh(items);
  EXPECT_TRUE(offered(bvh, {0, 5e-4, 5e-4}, {1, 9e-6, 0}).contains(1000));
}

TEST(Bvh, FarOriginsStillSeparateTheItems) {
  const Bvh bvh(row(1000));
  const auto found = offered(bvh, {1000.5, 1e9, 0.5}, {0, -1, 0});
  EXPECT_TRUE(found.contains(500));
  EXPECT_LE(found.size(), 4u);
}

// Hard case D18 for the accelerator: splitting never separates them.
TEST(Bvh, CoincidentItemsAreAllOffered) {
  const std::vector<Bounds> items(1000, cube({0, 0, 0}, 1));
  EXPECT_EQ(offered(Bvh(items), {-1, 0.5, 0.5}, {1, 0, 0}).size(), 1000u);
  const std::vector<Bounds> points(1000, cube({7, 7, 7}, 0));
  EXPECT_EQ(offered(Bvh(points), {6, 7, 7}, {1, 0, 0}).size(), 1000u);
}

// Each item twice as far as the last: a split by cost takes one or two away each time.
TEST(Bvh, LopsidedItemsDoNotOverflowTheStack) {
  std::vector<Bounds> items;
  for (int i = 0; i < 900; ++i)
    items.push_back(cube({std::ldexp(1.0, i - 450), 0, 0}, std::ldexp(0.25, i - 450)));
  const Bvh bvh(items);
  EXPECT_EQ(offered(bvh, {-1, 0, 0}, {1, 0, 0}).size(), 900u);
}

TEST(Bvh, ScenesOfAnySizeAndPlaceAreCulledAlike) {
  for (const double scale : {1e-140, 1e-30, 1.0, 1e30, 1e140}) {
    std::vector<Bounds> items;
    for (const Bounds& b : row(256)) items.push_back({b.low * scale, b.high * scale});
    const Bvh bvh(items);
    for (const double length : {1e-100, 1.0, 1e100}) {
      const auto found = offered(bvh, Vec3{200.5, 9, 0.5} * scale, Vec3{0, -length, 0});
      EXPECT_TRUE(found.contains(100)) << scale;
      EXPECT_LE(found.size(), 4u) << scale;
    }
  }
  std::vector<Bounds> items;
  for (const Bounds& b : row(256))
    items.push_back({b.low + Vec3{1e9, 1e9, 1e9}, b.high + Vec3{1e9, 1e9, 1e9}});
  const auto found = offered(Bvh(items), Vec3{1e9 + 200.5, 1e9 + 9, 1e9 + 0.5}, {0, -1, 0});
  EXPECT_TRUE(found.contains(100));
  EXPECT_LE(found.size(), 4u);
}

TEST(Bvh, DirectionsTooLongOrTooShortSeeEverything) {
  const Bvh bvh(row(64));
  EXPECT_EQ(offered(bvh, {-1, 0.5, 0.5}, {1e-200, 0, 0}).size(), 64u);
  EXPECT_EQ(offered(bvh, {-1, 0.5, 0.5}, {1e200, 0, 0}).size(), 64u);
  EXPECT_TRUE(offered(bvh, {-1e200, 0.5, 0.5}, {1, 0, 0}).contains(0));
}

TEST(Bvh, TakesAtMostSixtyBytesPerItem) {
  std::vector<Bounds> items;
  SeededRandom random(1);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 low = random.point(0, 1);
    items.push_back(cube(low, random.real(0, 0.02)));
  }
  EXPECT_LE(Bvh(items).bytes(), 60 * items.size());
}

}  // namespace
}  // namespace rayshade
