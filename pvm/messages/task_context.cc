// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/messages/task_context.h"

#include <algorithm>

namespace rayshade {

void TaskContext::flush() {
  if (loadEvery_ > 0) {
    const double now = link.now(), span = now - loadSent_;
    if (span >= loadEvery_) {
      outbox.post(loadTo_, Load{std::clamp(1 - (idleSeconds - idleThen_) / span, 0.0, 1.0)});
      loadSent_ = now;
      idleThen_ = idleSeconds;
    }
  }
  if (finished && record_) {
    EventLog log = record_->log();
    for (const auto& thread : ofThreads_) log.join(thread->log());
    outbox.record = nullptr;
    record_.reset();
    outbox.post(link.parent(), Observed{observed_, link.now(), std::move(log)});
  }
  outbox.flush();
}

void addTo(Report& report, const Traffic& t) {
  report.messagesIn = t.messagesIn;
  report.messagesOut = t.messagesOut;
  report.packetsIn = t.packetsIn;
  report.packetsOut = t.packetsOut;
  report.bytesIn = t.bytesIn;
  report.bytesOut = t.bytesOut;
  report.refused = t.refused;
  report.stale = t.stale;
}

void addTo(Report& report, const Usage& usage) {
  report.cpuSeconds = usage.cpuSeconds;
  report.peakMemory = usage.peakMemory;
}

Report TaskContext::counted() const {
  Report report;
  addTo(report, outbox.traffic);
  report.peakQueue = peakQueue;
  return report;
}

void TaskContext::close() {
  outbox.flush();
  outbox.record = nullptr;
}

Report TaskContext::closed(Report report) const {
  addTo(report, link.usage());
  report.idleSeconds = idleSeconds;
  report.waitSeconds = waitSeconds_;
  report.busySeconds = link.now() - born_ - idleSeconds;
  return report;
}

// ---- what is noted

void TaskContext::observe(const Observe& message) {
  mostEvents_ = std::min<std::uint32_t>(message.most, kMostEvents);
  observed_ = link.now();
  record_ = std::make_unique<EventRecord>(mostEvents_);
  outbox.record = record_.get();
}

void TaskContext::noteIdle(double seconds, std::uint64_t inHand) {
  idleSeconds += seconds;
  if (inHand > 0) waitSeconds_ += seconds;
  if (!record_) return;
  const double now = link.now();
  record_->span(inHand > 0 ? EventKind::wait : EventKind::idle, now - seconds, now);
  noteQueue(now, inHand);
}

void TaskContext::noteDecoded(const LinkEvent& event, double begin, std::uint64_t messages,
                              std::uint64_t waiting) {
  const auto from = static_cast<std::int32_t>(event.task);
  const double now = link.now();
  record_->add({nanoseconds(std::max(begin, observed_)), nanoseconds(now), EventKind::decode, 0, from,
                packetsFrom_[from]++, static_cast<std::uint32_t>(messages), event.bytes.size()});
  noteQueue(now, waiting);
}

void TaskContext::noteQueue(double now, std::uint64_t waiting) {
  constexpr double kEvery = 0.001;  // seconds
  if (waiting == queue_ || now < queueNoted_ + kEvery) return;
  queue_ = waiting;
  queueNoted_ = now;
  record_->at(now, EventKind::queue, 0, 0, static_cast<std::uint32_t>(waiting), 0);
}

void TaskContext::run(Link::Job job, RecordId number, std::int32_t x, std::int32_t y) {
  if (!record_) return link.run(std::move(job));
  link.run([this, job = std::move(job), number, x, y](unsigned worker) {
    const double begin = link.now();
    job(worker);
    ofThreads_.at(worker)->add({nanoseconds(begin), nanoseconds(link.now()), EventKind::tile, 0, 0,
                                static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(x),
                                static_cast<std::uint64_t>(y)});
  });
}

void TaskContext::useThreads(unsigned threads) {
  link.useThreads(threads);
  for (auto i = static_cast<std::uint16_t>(ofThreads_.size()); record_ && i < threads; ++i)
    ofThreads_.push_back(std::make_unique<EventRecord>(mostEvents_, i + 1));
}

}  // namespace rayshade
