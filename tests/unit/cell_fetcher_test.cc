// When a cell is fetched, and when rays travel instead.
// guarded: borrows cells of others
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/cell_fetcher.h"

#include <gtest/gtest.h>

#include "tests/support/null_link.h"
#include "tests/support/random.h"

namespace rayshade {
namespace {

constexpr std::uint32_t kCells = 64, kObjects = 200;

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

// A task that asks for cells, all alike, of which `cells` have room in its cache.
struct Asking {
  explicit Asking(std::size_t cells, std::uint32_t outstanding = 64) {
    cache.begin(1 << 20);
    bytesOfCell = cache.insert(CellId{0}, spheres(kObjects), {}, 1);
    at.tree = buildBinTree({{0, 0, 0}, {64, 1, 1}}, {kCells, kCells});
    at.directory.voxelTasks = {TaskId{9}};
    at.directory.voxels.assign(kCells, 0);
    at.directory.clusters = 1;
    at.cellBytes.assign(kCells, static_cast<std::uint32_t>(bytesOfCell / 4));
    at.policy.cacheBytes = cells * bytesOfCell + bytesOfCell / 2;
    at.policy.outstanding = outstanding;
    fetcher.begin();
  }
  bool arrive(std::uint32_t cell) { return fetcher.arrive({CellId{cell}, spheres(kObjects)}); }
  // Rays come one by one until the cell is asked for: how many bytes their travels cost.
  double travelled(std::uint32_t cell) {
    for (int rays = 1;; ++rays)
      if (fetcher.missed(CellId{cell}, 1, true)) return 130.0 * rays;
  }

  NullLink link;
  TaskContext context{link};
  EpochSettings at;
  ObjectCache cache;
  CellFetcher fetcher{context, at, cache};
  std::size_t bytesOfCell = 0;
};

TEST(CellFetcher, WhileThereIsRoomObjectsTravelAtOnceIfTheyAreTo) {
  Asking task(4);
  for (std::uint32_t cell = 0; cell < 4; ++cell) EXPECT_TRUE(task.fetcher.missed(CellId{cell}, 1, true));
  EXPECT_FALSE(task.fetcher.missed(CellId{4}, 1, true)) << "what is on its way has taken the room";
  for (std::uint32_t cell = 0; cell < 4; ++cell) EXPECT_TRUE(task.arrive(cell));
  EXPECT_EQ(task.cache.counts().evicted, 0u);
}

TEST(CellFetcher, ElseAFewRaysAreAReasonAndNotOne) {
  Asking task(4);
  EXPECT_FALSE(task.fetcher.missed(CellId{0}, 1, false));
  EXPECT_TRUE(task.fetcher.missed(CellId{0}, task.bytesOfCell / 64 / 130 + 1, false));
  EXPECT_TRUE(task.fetcher.missed(CellId{0}, 1, false)) << "it is on its way";
}

TEST(CellFetcher, WithoutRoomRaysTravelUntilTheyHaveCostAsMuchAsTheCell) {
  Asking task(2);
  for (std::uint32_t cell : {0u, 1u}) {
    task.fetcher.want(CellId{cell});
    EXPECT_TRUE(task.arrive(cell));
  }
  const auto bytes = static_cast<double>(task.bytesOfCell);
  EXPECT_NEAR(task.travelled(2), bytes, 130);
  EXPECT_TRUE(task.arrive(2));
  EXPECT_TRUE(task.cache.contains(CellId{2}));
  EXPECT_FALSE(task.cache.contains(CellId{0}));
  // Nobody looked into cell 0 while it was here: all cells are dearer now.
  EXPECT_NEAR(task.travelled(0), 16 * bytes, 130);
  EXPECT_TRUE(task.arrive(0));
}

TEST(CellFetcher, CellsThatAreMuchUsedMakeAllCheaper) {
  Asking task(2);
  for (std::uint32_t cell : {0u, 1u, 2u}) {
    task.fetcher.want(CellId{cell});
    EXPECT_TRUE(task.arrive(cell));
    task.cache.find(CellId{cell}, task.bytesOfCell);
  }
  EXPECT_NEAR(task.travelled(0), static_cast<double>(task.bytesOfCell) / 16, 130);
}

TEST(CellFetcher, WhateverRaysAskForFetchingCostsNoMoreThanTheCacheAndTravelling) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Asking task(static_cast<std::size_t>(random.integer(1, 12)));
    const auto most = static_cast<std::uint32_t>(random.integer(1, kCells - 1));
    double travelled = 0;
    // The worst there is: the next cell in a circle, never used while it is here.
    for (std::uint32_t i = 0; i < 20'000; ++i) {
      const CellId cell{random.oneIn(10) ? static_cast<std::uint32_t>(random.integer(0, kCells - 1))
                                         : i % most};
      if (task.fetcher.isHere(cell)) continue;
      if (task.fetcher.missed(cell, 1, random.oneIn(2))) {
        task.arrive(static_cast<std::uint32_t>(cell));
      } else {
        travelled += 130;
      }
    }
    EXPECT_LE(static_cast<double>(task.cache.counts().fetched * task.bytesOfCell),
              static_cast<double>(task.at.policy.cacheBytes) + 2 * travelled);
    EXPECT_LE(task.cache.counts().peakBytes, task.at.policy.cacheBytes);
  }
}

TEST(CellFetcher, AListIsAskedForAsFarAsItFits) {
  Asking task(8);
  std::vector<CellId> list;
  for (std::uint32_t cell = 0; cell < 20; ++cell) list.push_back(CellId{cell});
  task.at.cellBytes[1] = 0;  // nothing is there
  const double all = 1e9;
  EXPECT_EQ(task.fetcher.worthAsking(list, 1, true, all), 9u);
  EXPECT_EQ(task.fetcher.worthAsking(list, 1, true, 2.5 * static_cast<double>(task.bytesOfCell)), 3u);
  EXPECT_EQ(task.fetcher.worthAsking(list, 0, false, all), 0u) << "no ray would use it";
  task.fetcher.want(CellId{0});
  task.fetcher.want(CellId{5});
  EXPECT_EQ(task.fetcher.worthAsking(list, 1, true, all), 9u) << "what is coming has its room";
}

TEST(CellFetcher, TakesOnlyWhatItHasAskedFor) {
  Asking task(8, 2);
  EXPECT_FALSE(task.arrive(3));
  for (std::uint32_t cell = 0; cell < 4; ++cell) task.fetcher.want(CellId{cell});
  EXPECT_FALSE(task.arrive(2)) << "it is not asked for yet: two are on their way";
  EXPECT_TRUE(task.arrive(0));
  EXPECT_TRUE(task.arrive(2));
  EXPECT_FALSE(task.arrive(2));
  EXPECT_FALSE(task.fetcher.arrive({CellId{kCells + 7}, {}}));
}

}  // namespace
}  // namespace rayshade
