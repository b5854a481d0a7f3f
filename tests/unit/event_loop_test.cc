// When a task lets out what has gathered: with size and time, not whenever it has nothing to do.
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/messages/event_loop.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/null_link.h"

namespace rayshade {
namespace {

// Events come at given times of a clock that goes on only when the task works or sleeps.
class TimedLink final : public NullLink {
 public:
  std::optional<LinkEvent> poll() override { return wait(0); }
  std::optional<LinkEvent> wait(double seconds) override {
    const double end = time + seconds;
    if (next_ == arrivals.size() || arrivals[next_] > end) {
      time = end;
      return std::nullopt;
    }
    time = std::max(time, arrivals[next_++]);
    return LinkEvent{};
  }
  double now() const override { return time; }

  double time = 0;
  std::vector<double> arrivals;

 private:
  std::size_t next_ = 0;
};

// Each event brings work, and all work brings something to send.
class Worker {
 public:
  Worker(TimedLink& link, double workOfEach, double end) : link_(link), workOfEach_(workOfEach), end_(end) {}

  void receive(const LinkEvent&) { left_ += workOfEach_; }
  bool work(double until) {
    if (left_ > 0) gathered_ = true;
    const double now = std::min(until - link_.time, left_);
    left_ -= now;
    link_.time += now;
    return left_ > 1e-9;
  }
  void flush() {
    if (std::exchange(gathered_, false)) flushed.push_back(link_.time);
  }
  bool finished() const { return link_.time >= end_; }
  void noteIdle(double seconds) { idle += seconds; }

  std::vector<double> flushed;
  double idle = 0;

 private:
  TimedLink& link_;
  double workOfEach_, end_, left_ = 0;
  bool gathered_ = false;
};

TEST(EventLoop, WhatFollowsSoonLeavesTogether) {
  TimedLink link;
  for (int i = 0; i < 5; ++i) link.arrivals.push_back(0.1 + i * 0.8 * kHoldSeconds);
  Worker worker(link, 1e-5, 0.5);
  runTask(worker, link);
  ASSERT_EQ(worker.flushed.size(), 1u);
  EXPECT_NEAR(worker.flushed[0], link.arrivals.back() + kHoldSeconds, 1e-4);
}

TEST(EventLoop, WhatIsAloneLeavesSoon) {
  TimedLink link;
  link.arrivals = {0.1, 0.2, 0.3};
  Worker worker(link, 1e-5, 0.5);
  runTask(worker, link);
  ASSERT_EQ(worker.flushed.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(worker.flushed[i] - link.arrivals[i], kHoldSeconds + 1e-4);
  EXPECT_NEAR(worker.idle, link.time, 1e-3);
}

TEST(EventLoop, NothingIsHeldForLongWhateverComes) {
  TimedLink link;
  for (int i = 0; i < 400; ++i) link.arrivals.push_back(i * 0.5 * kHoldSeconds);
  Worker worker(link, 1e-6, link.arrivals.back());
  runTask(worker, link);
  double last = 0;
  for (const double at : worker.flushed) {
    EXPECT_LE(at - last, kMostHeldSeconds + 2 * kHoldSeconds);
    last = at;
  }
  EXPECT_LE(worker.flushed.size(), 2 + static_cast<std::size_t>(link.time / kMostHeldSeconds));
}

TEST(EventLoop, ABusyTaskLetsOutAfterEachSlice) {
  TimedLink link;
  link.arrivals = {0.1};
  Worker worker(link, 10 * kWorkSlice, 0.5);
  runTask(worker, link);
  EXPECT_GE(worker.flushed.size(), 5u);
  EXPECT_LE(worker.flushed.size(), 11u);
}

}  // namespace
}  // namespace rayshade
