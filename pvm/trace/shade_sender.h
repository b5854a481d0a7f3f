// Tells shade tasks of intersections, so that they reserve a place for the colours that will come (Reinhard & Jansen, figure 3).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/messages/task_context.h"
#include "pvm/trace/epoch_settings.h"

namespace rayshade {

class ShadeSender {
 public:
  ShadeSender(TaskContext& context, const EpochSettings& at) : context_(context), at_(at) {}

  // A new epoch.  `finder`: this task's number among those that find intersections.
  void begin(std::uint32_t finder) {
    finder_ = finder;
    numbers_.assign(at_.directory.shadeTasks.size(), 0);
  }

  // Sends all of `message` but its record, which is chosen here, to some shade task; `waits`: for colours that are still to come.
  // Says where these go: slot 0 of the record.  A directory without shade tasks is the host's mistake: refused.
  ReplyTo send(Expect& message, bool waits) {
    if (at_.directory.shadeTasks.empty()) {
      ++context_.outbox.traffic.refused;
      return {};
    }
    const std::size_t chosen = chooseShadeTask(at_.directory, serial_++);
    const TaskId shader = at_.directory.shadeTasks[chosen];
    message.record = recordOf(finder_, numbers_[chosen]);
    context_.outbox.post(shader, message);
    if (waits) ++numbers_[chosen];
    return {shader, message.record, 0};
  }

 private:
  TaskContext& context_;
  const EpochSettings& at_;
  std::uint32_t finder_ = 0;
  std::uint64_t serial_ = 0;            // of the next intersection found here
  std::vector<std::uint64_t> numbers_;  // of the next record at each shade task
};

}  // namespace rayshade
