// What every slave task has: its link, its outbox, its epoch, and what it counts about itself.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "pvm/messages/inbox.h"

namespace rayshade {

// What is known of any task: traffic, CPU time, memory.
void addTo(Report& report, const Traffic& traffic);
void addTo(Report& report, const Usage& usage);

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
    outbox.note(EventKind::epoch, kNobody, static_cast<std::uint32_t>(epoch), 0, 0);
    reportLoad(host, message.loadEvery);
  }
  // Tells the host how busy this task has been, every so often if at all.
  void reportLoad(TaskId host, double every) {
    loadTo_ = host;
    loadEvery_ = every;
  }
  void flush();

  // ---- what is noted for the host, if it wants it

  void observe(const Observe& message);
  // Something is done as long as this lives.
  class Doing {
   public:
    Doing(TaskContext& context, EventKind kind)
        : context_(context), kind_(kind), begin_(context.record_ ? context.link.now() : 0) {}
    Doing(const Doing&) = delete;
    ~Doing() {
      if (context_.record_) context_.record_->span(kind_, begin_, context_.link.now());
    }

   private:
    TaskContext& context_;
    EventKind kind_;
    double begin_;
  };
  // So long nothing was done, until now, and so much is in hand.
  void noteIdle(double seconds, std::uint64_t inHand);
  // Link::useThreads, and Link::run of a job that traces a tile, or samples with the number of the first.
  void useThreads(unsigned threads);
  void run(Link::Job job, RecordId number, std::int32_t x, std::int32_t y);

  void notePeak(std::uint64_t waiting) { peakQueue = std::max(peakQueue, waiting); }

  // The part of a report that is the same for all tasks: what was counted, and at the end times and memory.
  Report counted() const;
  // The end: lets out what has gathered, so that it is counted; what is sent later is not.
  void close();
  Report closed(Report counted) const;

 private:
  friend class Doing;
  template <class Task>
  friend void receiveEvent(Task& task, TaskContext& context, const LinkEvent& event);
  void noteDecoded(const LinkEvent& event, double begin, std::uint64_t messages, std::uint64_t waiting);
  void noteQueue(double now, std::uint64_t waiting);

  double born_;
  TaskId loadTo_ = kNobody;
  double waitSeconds_ = 0;
  double loadEvery_ = 0, loadSent_ = 0, idleThen_ = 0;

  std::unique_ptr<EventRecord> record_;                          // null: nothing is noted
  std::vector<std::unique_ptr<EventRecord>> ofThreads_;          // that do jobs
  std::uint32_t mostEvents_ = 0;                                 // of each
  double observed_ = 0;                                          // since when
  std::unordered_map<std::int32_t, std::uint32_t> packetsFrom_;  // by sender
  double queueNoted_ = 0;
  std::uint64_t queue_ = 0;  // as it was noted
};

// Hands a link event to a task: packets are decoded; the death of the task's parent, the host, ends it.
template <class Task>
void receiveEvent(Task& task, TaskContext& context, const LinkEvent& event) {
  if (event.kind == LinkEvent::Kind::packet) {
    const std::uint64_t before = context.outbox.traffic.messagesIn;
    const double begin = context.record_ ? context.link.now() : 0;
    receivePacket(task, event.task, event.bytes, context.outbox.traffic);
    if (context.record_)
      context.noteDecoded(event, begin, context.outbox.traffic.messagesIn - before, task.waiting());
  } else if (event.kind == LinkEvent::Kind::taskExit && event.task == context.link.parent()) {
    context.finished = true;
  }
}

}  // namespace rayshade
