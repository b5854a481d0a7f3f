// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/bounds_sample.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace rayshade {
namespace {

Bounds box(std::uint64_t i) {
  Random random(i);
  const Vec3 low = random.point(0, 1);
  const double side = 0.001 + 0.1 * std::pow(random.real(), 8);
  return {low, low + Vec3{side, side, side}};
}
double area(const Bounds& b) { return 6 * b.size().x * b.size().x; }

TEST(BoundsSample, OfFewObjectsIsAllOfThem) {
  BoundsSample sample(10);
  for (std::uint64_t i = 0; i < 10; ++i) sample.add(box(i));
  const std::vector<BoundsSample::Box> boxes = sample.boxes();
  ASSERT_EQ(boxes.size(), 10u);
  for (std::uint64_t i = 0; i < 10; ++i) {
    EXPECT_EQ(boxes[i].bounds, box(i));
    EXPECT_EQ(boxes[i].weight, 1);
  }
}

TEST(BoundsSample, OfManyObjectsKeepsTheSumOfTheirAreasInEveryPartOfSpace) {
  BoundsSample sample(1000);
  double left = 0, right = 0;
  for (std::uint64_t i = 0; i < 50'000; ++i) {
    sample.add(box(i));
    (box(i).low.x < 0.3 ? left : right) += area(box(i));
  }
  double leftKept = 0, rightKept = 0;
  const std::vector<BoundsSample::Box> boxes = sample.boxes();
  ASSERT_EQ(boxes.size(), 1000u);
  for (const BoundsSample::Box& b : boxes)
    (b.bounds.low.x < 0.3 ? leftKept : rightKept) += b.weight * area(b.bounds);
  EXPECT_NEAR(leftKept / left, 1, 0.15);
  EXPECT_NEAR(rightKept / right, 1, 0.1);
}

TEST(BoundsSample, LargeObjectsAreAlwaysIn) {
  BoundsSample sample(100);
  const Bounds floor{{-50, -50, 0}, {50, 50, 0}};
  for (std::uint64_t i = 0; i < 5000; ++i) sample.add(i == 777 ? floor : box(i));
  int found = 0;
  for (const BoundsSample::Box& b : sample.boxes()) {
    if (!(b.bounds == floor)) continue;
    ++found;
    EXPECT_EQ(b.weight, 1);
  }
  EXPECT_EQ(found, 1);
}

TEST(BoundsSample, BytesMayCountInPlaceOfAreas) {
  BoundsSample sample(1000);
  double left = 0, leftKept = 0;
  const auto bytes = [](std::uint64_t i) { return 100.0 + static_cast<double>(i % 7) * 50; };
  for (std::uint64_t i = 0; i < 50'000; ++i) {
    sample.add(box(i), bytes(i));
    if (box(i).low.x < 0.3) left += bytes(i);
  }
  for (const BoundsSample::Box& b : sample.boxes())
    if (b.bounds.low.x < 0.3) leftKept += b.weight * b.size;
  EXPECT_NEAR(leftKept / left, 1, 0.15);
  BoundsSample points;
  points.add({{1, 2, 3}, {1, 2, 3}}, 5);
  ASSERT_EQ(points.boxes().size(), 1u);
  EXPECT_EQ(points.boxes()[0].size, 5);
}

TEST(BoundsSample, PointsAndBoundsThatAreNoBoxAreLeftOut) {
  BoundsSample sample;
  sample.add(Bounds{});
  sample.add(kEverywhere);
  sample.add({{1, 2, 3}, {1, 2, 3}});
  sample.add({{-1e300, -1e300, 0}, {1e300, 1e300, 0}});
  sample.add({{std::nan(""), 0, 0}, {1, 1, 1}});
  EXPECT_TRUE(sample.boxes().empty());
}

}  // namespace
}  // namespace rayshade
