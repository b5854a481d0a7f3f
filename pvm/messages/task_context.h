// What every slave task has: its link, its outbox, its epoch, and what it counts about itself.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/messages/inbox.h"

namespace rayshade {

// What a process knows of itself: traffic, CPU time, memory.
Report reportOf(const Traffic& traffic);

class TaskContext {
 public:
  explicit TaskContext(Link& link) : link(link), outbox(link), born_(link.now()) {}

  Link& link;
  Outbox outbox;
  Epoch epoch{};
  bool finished = false;
  std::uint64_t peakQueue = 0;
  double idleSeconds = 0;

  // A new epoch: what is open goes out with the old one, and what comes must be of the new one.
  void beginEpoch(TaskId host, const Configure& message) {
    outbox.beginEpoch(message.epoch);
    epoch = message.epoch;
    reportLoad(host, message.loadEvery);
  }
  // Tells the host how busy this task has been, every so often if at all.
  void reportLoad(TaskId host, double every) {
    loadTo_ = host;
    loadEvery_ = every;
  }
  void flush();

  void notePeak(std::uint64_t waiting) { peakQueue = std::max(peakQueue, waiting); }

  // The part of a report that is the same for all tasks.
  Report report() const;

 private:
  double born_;
  TaskId loadTo_ = kNobody;
  double loadEvery_ = 0, loadSent_ = 0, idleThen_ = 0;
};

// Hands a link event to a task: packets are decoded; the death of the task's parent, the host, ends it.
template <class Task>
void receiveEvent(Task& task, TaskContext& context, const LinkEvent& event) {
  if (event.kind == LinkEvent::Kind::packet) {
    receivePacket(task, event.task, event.bytes, context.outbox.traffic);
  } else if (event.kind == LinkEvent::Kind::taskExit && event.task == context.link.parent()) {
    context.finished = true;
  }
}

}  // namespace rayshade
