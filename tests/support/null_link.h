// A link that leads nowhere: what a task says is counted and forgotten.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/link/link.h"

namespace rayshade {

class NullLink : public Link {
 public:
  TaskId self() const override { return TaskId{2}; }
  TaskId parent() const override { return TaskId{1}; }
  void send(TaskId, std::span<const std::byte> packet) override {
    ++packets;
    bytes += packet.size();
  }
  std::optional<LinkEvent> poll() override { return std::nullopt; }
  std::optional<LinkEvent> wait(double) override { return std::nullopt; }
  void watch(TaskId) override {}
  double now() const override { return time_ += 1e-5; }
  Usage usage() const override { return {}; }
  unsigned cores() const override { return 1; }
  void useThreads(unsigned) override {}
  void run(Job job) override { job(0); }

  std::size_t packets = 0, bytes = 0;

 private:
  mutable double time_ = 0;
};

}  // namespace rayshade
