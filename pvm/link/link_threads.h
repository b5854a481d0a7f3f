// The threads of a task, and how they wake the one that waits for packets.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "pvm/link/link.h"
#include "rayshade/base/crew.h"

namespace rayshade {

class LinkThreads {
 public:
  LinkThreads() = default;
  LinkThreads(const LinkThreads&) = delete;
  LinkThreads& operator=(const LinkThreads&) = delete;
  ~LinkThreads();

  void use(unsigned threads);
  void run(Link::Job job);
  // Becomes readable when a job is done; -1: there are no threads.
  int descriptor() const { return descriptor_; }
  // Has a job been done since the last call?  Throws what a job has thrown.
  bool takeDone();

 private:
  int descriptor_ = -1;
  std::unique_ptr<Crew> crew_;  // the owner, who is one of them, does no jobs
};

}  // namespace rayshade
