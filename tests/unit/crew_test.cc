// The threads of a program, and those of a task.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/crew.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

namespace rayshade {
namespace {

TEST(Crew, DoesEachJobOnceAndNoWorkerTwoAtATime) {
  for (const unsigned size : {1u, 2u, 5u}) {
    constexpr int kJobs = 1000;
    std::vector<std::atomic<int>> done(kJobs), busy(size);
    std::atomic<int> told = 0;
    {
      Crew crew(size, [&] { ++told; });
      EXPECT_EQ(crew.size(), size);
      for (int i = 0; i < kJobs; ++i)
        crew.give([&, i](unsigned worker) {
          ASSERT_LT(worker, size);
          EXPECT_EQ(busy[worker]++, 0);
          ++done[static_cast<std::size_t>(i)];
          --busy[worker];
        });
      while (crew.left() > 0)
        if (!crew.work()) crew.waitForOne();
      crew.rethrow();
    }
    for (const auto& count : done) EXPECT_EQ(count, 1);
    EXPECT_EQ(told, kJobs);
  }
}

TEST(Crew, OfOneStartsNoThread) {
  Crew crew(1);
  const auto self = std::this_thread::get_id();
  bool done = false;
  crew.give([&](unsigned worker) {
    EXPECT_EQ(worker, 0u);
    EXPECT_EQ(std::this_thread::get_id(), self);
    done = true;
  });
  EXPECT_FALSE(done);
  EXPECT_TRUE(crew.work());
  EXPECT_TRUE(done);
  EXPECT_FALSE(crew.work());
}

TEST(Crew, TellsTheOwnerWhatAJobThrows) {
  Crew crew(3);
  for (int i = 0; i < 20; ++i)
    crew.give([i](unsigned) {
      if (i == 7) throw std::runtime_error("seven");
    });
  while (crew.left() > 0)
    if (!crew.work()) crew.waitForOne();
  EXPECT_THROW(crew.rethrow(), std::runtime_error);
  EXPECT_NO_THROW(crew.rethrow());  // once
}

TEST(Crew, DropsWhatHasNotBegunWhenItEnds) {
  std::atomic<int> done = 0;
  {
    Crew crew(2);
    for (int i = 0; i < 1000; ++i)
      crew.give([&](unsigned) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ++done;
      });
  }
  EXPECT_LT(done, 1000);
}

}  // namespace
}  // namespace rayshade
