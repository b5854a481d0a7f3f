// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/events/event_record.h"

namespace rayshade {

EventLog EventRecord::log() const {
  EventLog log{dropped_, totals_, events_};
  if (dropped_ > 0 && !events_.empty())
    std::rotate(log.events.begin(), log.events.begin() + static_cast<std::ptrdiff_t>(last_ + 1),
                log.events.end());
  return log;
}

void EventLog::join(EventLog&& other) {
  dropped += other.dropped;
  for (std::size_t kind = 0; kind < kEventKindCount; ++kind) {
    totals[kind].events += other.totals[kind].events;
    totals[kind].nanoseconds += other.totals[kind].nanoseconds;
    totals[kind].count += other.totals[kind].count;
    totals[kind].amount += other.totals[kind].amount;
  }
  const auto middle = static_cast<std::ptrdiff_t>(events.size());
  events.insert(events.end(), other.events.begin(), other.events.end());
  std::inplace_merge(events.begin(), events.begin() + middle, events.end(),
                     [](const Event& a, const Event& b) { return a.end < b.end; });
}

}  // namespace rayshade
