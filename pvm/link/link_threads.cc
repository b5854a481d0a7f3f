// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/link_threads.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <system_error>

namespace rayshade {

LinkThreads::~LinkThreads() { use(0); }

void LinkThreads::use(unsigned threads) {
  crew_.reset();
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
  if (threads == 0) return;
  descriptor_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  crew_ = std::make_unique<Crew>(threads + 1, [descriptor = descriptor_] { eventfd_write(descriptor, 1); });
  if (crew_->size() == 1)
    throw std::system_error(EAGAIN, std::generic_category(), "a thread cannot be started");
}

void LinkThreads::run(Link::Job job) {
  crew_->give([job = std::move(job)](unsigned worker) { job(worker - 1); });
}

bool LinkThreads::takeDone() {
  eventfd_t count = 0;
  if (descriptor_ < 0 || eventfd_read(descriptor_, &count) != 0) return false;
  crew_->rethrow();
  return true;
}

}  // namespace rayshade
