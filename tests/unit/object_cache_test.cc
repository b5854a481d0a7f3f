// The cache of other tasks' cells: bounded in bytes, least recently used out first, what is in use stays.
// guarded: borrows cells of others
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/object_cache.h"

#include <gtest/gtest.h>

namespace rayshade {
namespace {

std::vector<Item> spheres(std::uint32_t count) {
  std::vector<Item> items;
  for (std::uint32_t i = 0; i < count; ++i) {
    SceneObject object;
    object.id = ObjectId{i};
    object.body = Sphere{{3.0 * i, 0, 0}, 1};
    items.emplace_back(object);
  }
  return items;
}
void insert(ObjectCache& cache, std::uint32_t cell, std::uint32_t objects = 4) {
  cache.insert(CellId{cell}, spheres(objects), {}, 100);
}
// What a cell takes: they are all alike.
std::size_t bytesOfCell() {
  ObjectCache cache;
  cache.begin(1 << 20);
  insert(cache, 0);
  return cache.counts().peakBytes;
}
std::vector<std::uint32_t> held(const ObjectCache& cache) {
  std::vector<std::uint32_t> cells;
  for (std::uint32_t cell = 0; cell < 100; ++cell)
    if (cache.contains(CellId{cell})) cells.push_back(cell);
  return cells;
}
using Cells = std::vector<std::uint32_t>;

TEST(ObjectCache, ACellIsReadyToBeVisited) {
  ObjectCache cache;
  cache.begin(1 << 20);
  insert(cache, 5, 7);
  const RegionRef ground = cache.find(CellId{5});
  ASSERT_NE(ground.region, nullptr);
  EXPECT_EQ(ground.region->objects.size(), 7u);
  Ray ray;
  ray.origin = {6, -10, 0};
  ray.direction = {0, 1, 0};
  const Hit hit = nearestHit(*ground.model, *ground.region, ray, 0, kInfinity);
  ASSERT_TRUE(hit.found());
  EXPECT_EQ(hit.t, 9);
  EXPECT_EQ(ground.model->store().object(hit.object).id, ObjectId{2});
  EXPECT_EQ(cache.find(CellId{6}).region, nullptr);
}

TEST(ObjectCache, TheLeastRecentlyUsedGoesFirst) {
  ObjectCache cache;
  cache.begin(3 * bytesOfCell());
  for (std::uint32_t cell : {0u, 1u, 2u}) insert(cache, cell);
  EXPECT_EQ(held(cache), (Cells{0, 1, 2}));
  cache.find(CellId{0});
  insert(cache, 3);
  EXPECT_EQ(held(cache), (Cells{0, 2, 3}));
  insert(cache, 4);
  EXPECT_EQ(held(cache), (Cells{0, 3, 4}));
  insert(cache, 5);
  EXPECT_EQ(held(cache), (Cells{3, 4, 5}));
}

TEST(ObjectCache, LookingWhetherACellIsHereIsNoUse) {
  ObjectCache cache;
  cache.begin(2 * bytesOfCell());
  insert(cache, 0);
  insert(cache, 1);
  EXPECT_TRUE(cache.contains(CellId{0}));
  insert(cache, 2);
  EXPECT_EQ(held(cache), (Cells{1, 2}));
}

TEST(ObjectCache, WithoutRoomTheLastCellStaysUntilTheNextComes) {
  ObjectCache cache;
  cache.begin(0);
  for (std::uint32_t cell = 0; cell < 5; ++cell) {
    insert(cache, cell);
    EXPECT_EQ(held(cache), Cells{cell});
  }
}

TEST(ObjectCache, ALargeCellPushesOutAsManySmallOnesAsItNeeds) {
  ObjectCache cache;
  cache.begin(4 * bytesOfCell());
  for (std::uint32_t cell : {0u, 1u, 2u, 3u}) insert(cache, cell);
  insert(cache, 9, 2000);
  EXPECT_EQ(held(cache), Cells{9});
  insert(cache, 1);
  EXPECT_EQ(held(cache), Cells{1});
}

TEST(ObjectCache, PinnedCellsStayThroughAnything) {
  ObjectCache cache;
  cache.begin(bytesOfCell());
  insert(cache, 0);
  cache.pin(CellId{0});
  const Region* region = cache.find(CellId{0}).region;
  for (std::uint32_t cell = 1; cell < 6; ++cell) insert(cache, cell);
  EXPECT_EQ(held(cache), (Cells{0, 5}));
  EXPECT_EQ(cache.find(CellId{0}).region, region) << "and where they are";
  cache.pin(CellId{0});
  cache.unpin(CellId{0});
  insert(cache, 6);
  EXPECT_EQ(held(cache), (Cells{0, 6})) << "pinned twice, let go once";
}

TEST(ObjectCache, WhatIsLetGoMakesRoomAtOnce) {
  ObjectCache cache;
  cache.begin(2 * bytesOfCell());
  for (std::uint32_t cell = 0; cell < 4; ++cell) {
    insert(cache, cell);
    cache.pin(CellId{cell});
  }
  EXPECT_EQ(held(cache), (Cells{0, 1, 2, 3})) << "more than there is room for, all of it in use";
  cache.unpin(CellId{1});
  EXPECT_EQ(held(cache), (Cells{0, 2, 3}));
  cache.unpin(CellId{2});
  EXPECT_EQ(held(cache), (Cells{0, 3}));
  cache.unpin(CellId{0});
  EXPECT_EQ(held(cache), (Cells{0, 3})) << "there is room for two";
}

TEST(ObjectCache, CellsThatAreNotHereCannotBePinned) {
  ObjectCache cache;
  cache.begin(0);
  cache.pin(CellId{3});
  cache.unpin(CellId{3});
  insert(cache, 3);
  insert(cache, 4);
  EXPECT_EQ(held(cache), Cells{4});
}

TEST(ObjectCache, ACellThatIsHereAlreadyIsNotTakenAgain) {
  ObjectCache cache;
  cache.begin(1 << 20);
  insert(cache, 0, 2);
  insert(cache, 0, 9);
  EXPECT_EQ(cache.find(CellId{0}).region->objects.size(), 2u);
  EXPECT_EQ(cache.counts().fetched, 1u);
}

TEST(ObjectCache, ANewEpochBeginsEmpty) {
  ObjectCache cache;
  cache.begin(bytesOfCell());
  insert(cache, 0);
  cache.pin(CellId{0});
  cache.begin(bytesOfCell());
  EXPECT_TRUE(held(cache).empty());
  insert(cache, 1);
  insert(cache, 2);
  EXPECT_EQ(held(cache), Cells{2}) << "the bytes of the old epoch are forgotten too";
}

TEST(ObjectCache, CountsWhatHappens) {
  ObjectCache cache;
  const std::size_t bytes = bytesOfCell();
  cache.begin(2 * bytes);
  for (std::uint32_t cell : {0u, 1u, 2u}) insert(cache, cell);
  cache.find(CellId{0});
  cache.find(CellId{1});
  cache.find(CellId{2});
  EXPECT_EQ(cache.counts().lookups, 3u);
  EXPECT_EQ(cache.counts().hits, 2u);
  EXPECT_EQ(cache.counts().fetched, 3u);
  EXPECT_EQ(cache.counts().fetchedBytes, 300u);
  EXPECT_EQ(cache.counts().evicted, 1u);
  EXPECT_EQ(cache.counts().peakBytes, 2 * bytes);
}

}  // namespace
}  // namespace rayshade
