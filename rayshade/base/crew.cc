// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/crew.h"

#include <csignal>
#include <system_error>
#include <utility>

namespace rayshade {

// Signals are for the owner's thread.
Crew::Crew(unsigned size, std::function<void()> told) : told_(std::move(told)) {
  if (size <= 1) return;
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    for (unsigned worker = 1; worker < size; ++worker)
      threads_.emplace_back([this, worker] { serve(worker); });
  } catch (const std::system_error&) {  // no memory for another stack, or too many threads
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

Crew::~Crew() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    jobs_.clear();
  }
  given_.notify_all();
}

void Crew::give(Job job) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
    ++left_;
  }
  given_.notify_one();
}

bool Crew::work() {
  Job job;
  {
    const std::lock_guard lock(mutex_);
    if (jobs_.empty()) return false;
    job = std::move(jobs_.front());
    jobs_.pop_front();
  }
  run(job, 0);
  return true;
}

void Crew::waitForOne() {
  std::unique_lock lock(mutex_);
  done_.wait(lock, [&] { return oneDone_ || left_ == 0; });
  oneDone_ = false;
}

std::size_t Crew::left() const {
  const std::lock_guard lock(mutex_);
  return left_;
}

void Crew::rethrow() {
  const std::lock_guard lock(mutex_);
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

void Crew::serve(unsigned worker) {
  for (;;) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      given_.wait(lock, [&] { return ending_ || !jobs_.empty(); });
      if (ending_) return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
    }
    run(job, worker);
  }
}

void Crew::run(Job& job, unsigned worker) {
  std::exception_ptr thrown;
  try {
    job(worker);
  } catch (...) {
    thrown = std::current_exception();
  }
  {
    const std::lock_guard lock(mutex_);
    if (thrown && !thrown_) thrown_ = thrown;
    --left_;
    oneDone_ = true;
  }
  done_.notify_one();
  if (told_) told_();
}

}  // namespace rayshade
