// The events of one task or thread, in bounded memory: the latest are kept, all are counted.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "rayshade/base/archive.h"
#include "rayshade/events/event.h"

namespace rayshade {

inline constexpr std::size_t kMostEvents = 200'000;  // of a task, 8 MB; of a thread of it as many

constexpr std::uint64_t nanoseconds(double seconds) {
  return static_cast<std::uint64_t>(seconds * 1e9 + 0.5);
}

// What a record becomes when it is closed.
struct EventLog {
  std::uint64_t dropped = 0;  // the first ones
  EventTotals totals;
  std::vector<Event> events;  // in the order of their ends

  // Of another thread of the same task.
  void join(EventLog&& other);
};

class EventRecord {
 public:
  explicit EventRecord(std::size_t most, std::uint16_t thread = 0) : most_(most), thread_(thread) {}

  void add(Event event) {
    event.thread = thread_;
    EventTotal& total = totals_[static_cast<std::size_t>(event.kind)];
    ++total.events;
    total.nanoseconds += event.end - event.begin;
    total.count += event.count;
    total.amount += event.amount;
    if (isOneWith(event)) {
      events_[last_].end = event.end;
    } else if (events_.size() < most_) {
      last_ = events_.size();
      events_.push_back(event);
    } else if (most_ > 0) {
      last_ = (last_ + 1) % most_;
      events_[last_] = event;
      ++dropped_;
    } else {
      ++dropped_;
    }
  }
  // A span without numbers; times in seconds.
  void span(EventKind kind, double begin, double end) { add({nanoseconds(begin), nanoseconds(end), kind}); }
  void at(double now, EventKind kind, std::int32_t peer, std::uint32_t number, std::uint32_t count,
          std::uint64_t amount) {
    add({nanoseconds(now), nanoseconds(now), kind, 0, peer, number, count, amount});
  }

  EventLog log() const;

 private:
  // Spans without numbers that follow each other closely are one.
  bool isOneWith(const Event& event) const {
    constexpr std::uint64_t kGap = 2000;  // nanoseconds
    return isBareSpan(event.kind) && !events_.empty() && events_[last_].kind == event.kind &&
           event.begin <= events_[last_].end + kGap;
  }

  std::size_t most_;
  std::uint16_t thread_;
  std::vector<Event> events_;  // a ring, when it is full
  std::size_t last_ = 0;
  std::uint64_t dropped_ = 0;
  EventTotals totals_{};
};

template <class Archive>
void serialize(Archive& archive, EventLog& log) {
  archive(log.dropped, log.totals, log.events);
}

}  // namespace rayshade
