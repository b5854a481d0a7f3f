// Threads that do jobs for an owner, who works, too, when there is nothing else to do.
//
// The owner's thread gives jobs and does one himself with work(); the others take them in the order in which they were given.  A crew
// of one has no threads: every job is done in work(), in order.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace rayshade {

class Crew {
 public:
  // `worker`: 0 is the owner, then 1 .. size() - 1; no two jobs of one worker are done at a time.
  using Job = std::function<void(unsigned worker)>;

  // `size`: threads, with the owner's; at least one.  There are fewer when the system gives no more.  `told` is called after each job, by whoever has done it.
  explicit Crew(unsigned size, std::function<void()> told = {});
  // Ends when the jobs that have begun are done; the others are dropped.
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  unsigned size() const { return static_cast<unsigned>(threads_.size()) + 1; }

  // All that follows is for the owner.
  void give(Job job);
  // Does one job; false: none is waiting.
  bool work();
  // Waits until a job is done by somebody; returns at once if one was since the last call, or if nothing is to be done.
  void waitForOne();
  // Jobs that were given and are not done.
  std::size_t left() const;
  // Throws what a job has thrown.
  void rethrow();

 private:
  void serve(unsigned worker);
  void run(Job& job, unsigned worker);

  mutable std::mutex mutex_;  // of all that follows
  std::condition_variable given_, done_;
  std::deque<Job> jobs_;
  std::size_t left_ = 0;
  bool oneDone_ = false;  // since the owner looked
  bool ending_ = false;
  std::exception_ptr thrown_;
  std::function<void()> told_;
  std::vector<std::jthread> threads_;
};

}  // namespace rayshade
