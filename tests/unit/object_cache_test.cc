// The cache of other tasks' cells: bounded in bytes, least recently used out first.
// guarded: borrows cells of others
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/object_cache.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/sphere_items.h"

namespace rayshade {
namespace {

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

TEST(ObjectCache, ItNeverHoldsMoreThanItsRoomButForOneCell) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    ObjectCache cache;
    const std::size_t most = static_cast<std::size_t>(random.integer(0, 200'000));
    cache.begin(most);
    std::size_t largest = 0;
    for (int i = 0; i < 60; ++i) {
      const CellId cell{static_cast<std::uint32_t>(random.integer(0, 30))};
      largest = std::max(
          largest, cache.insert(cell, spheres(static_cast<std::uint32_t>(random.integer(1, 200))), {}, 1));
      EXPECT_TRUE(cache.contains(cell));
      std::size_t sum = 0;
      for (std::uint32_t other : held(cache)) sum += cache.bytesOf(CellId{other});
      EXPECT_EQ(cache.bytes(), sum);
      EXPECT_TRUE(cache.bytes() <= most || held(cache).size() == 1);
    }
    EXPECT_LE(cache.counts().peakBytes, std::max(most, largest));
  }
}

TEST(ObjectCache, RemembersWhatCellsWereWorthThatLeft) {
  ObjectCache cache;
  cache.begin(bytesOfCell());
  insert(cache, 0);
  cache.find(CellId{0}, 30);
  cache.find(CellId{0}, 12);
  EXPECT_EQ(cache.ofThoseThatLeft().bytes, 0);
  insert(cache, 1);
  EXPECT_EQ(cache.ofThoseThatLeft().rays, 42);
  EXPECT_EQ(cache.ofThoseThatLeft().bytes, static_cast<double>(bytesOfCell()));
  insert(cache, 2);
  EXPECT_LT(cache.ofThoseThatLeft().rays, 42) << "nobody has looked into cell 1";
}

// ---- joining

TEST(ObjectCache, JoinsWhatHasComeWithEachObjectOnce) {
  ObjectCache cache;
  cache.begin(1 << 20);
  insert(cache, 0, 40);
  insert(cache, 7, 60);  // the 40, and more
  cache.find(CellId{0}, 100'000);
  EXPECT_EQ(cache.find(CellId{7}, 100'000).region->objects.size(), 60u);
  ASSERT_TRUE(cache.join(0, {}));
  EXPECT_EQ(held(cache), (Cells{0, 7}));
  EXPECT_TRUE(cache.isJoined(CellId{0}));
  EXPECT_EQ(cache.find(CellId{7}).region, nullptr) << "there is no single cell any more";
  EXPECT_EQ(cache.joinedRegion().objects.size(), 60u);
  EXPECT_EQ(cache.joinedModel().leftOut(), 0u);
  insert(cache, 7, 60);
  EXPECT_FALSE(cache.find(CellId{7}).region) << "it is here";
  insert(cache, 3, 80);
  cache.find(CellId{3}, 100'000);
  ASSERT_TRUE(cache.join(0, {}));
  EXPECT_EQ(cache.joinedRegion().objects.size(), 80u);
  EXPECT_EQ(held(cache), (Cells{0, 3, 7}));
  EXPECT_LT(cache.bytes(), 2 * cache.joinedModel().bytes());
  cache.begin(1 << 20);
  EXPECT_TRUE(held(cache).empty());
  EXPECT_EQ(cache.bytes(), 0u);
}

TEST(ObjectCache, JoinsOnlyWhenRaysHaveLookedOftenEnoughForWhatItCosts) {
  ObjectCache cache;
  cache.begin(1 << 20);
  EXPECT_FALSE(cache.join(0, {})) << "nothing is here";
  insert(cache, 0, 100);
  EXPECT_FALSE(cache.join(0, {}));
  cache.find(CellId{0}, cache.bytes() / 100);
  EXPECT_FALSE(cache.join(0, {}));
  cache.find(CellId{0}, cache.bytes());
  EXPECT_TRUE(cache.join(0, {}));
  insert(cache, 1, 2);
  EXPECT_FALSE(cache.join(0, {})) << "looks are counted from the last time";
}

TEST(ObjectCache, JoinsOnlyWhenAllThereIsHasRoom) {
  ObjectCache cache;
  cache.begin(1 << 20);
  insert(cache, 0);
  cache.find(CellId{0}, 1 << 20);
  EXPECT_FALSE(cache.join(0.9 * (1 << 20), {})) << "some of it will have to go";
  EXPECT_TRUE(cache.join(0.6 * (1 << 20), {}));
  cache.begin(bytesOfCell() + bytesOfCell() / 4);
  insert(cache, 0);
  cache.find(CellId{0}, 1 << 20);
  EXPECT_FALSE(cache.join(0, {})) << "there is no room for the work";
  EXPECT_LE(cache.counts().peakBytes, 1u << 20);
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
