// The life of every slave task, once: take in what has come, work a little, let out what has gathered, sleep.
//
// Taking in comes first in every turn: PVM's daemons buffer without limit, so they must find it empty.
//
// A full packet goes by itself (outbox.h).  The others do not go as soon as the task has nothing to do: more is likely to
// come, and a packet costs as much as reading a hundred rays.  They go when nothing has come for kHoldSeconds, and at
// the latest after kMostHeldSeconds, for somebody may wait for them.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/messages/inbox.h"

namespace rayshade {

inline constexpr double kWorkSlice = 0.004;  // seconds of work between two looks at the link
inline constexpr double kHoldSeconds = 0.0005;
inline constexpr double kMostHeldSeconds = 0.004;
inline constexpr double kPatience = 1.0;  // seconds of sleep when nothing comes

// A task has: receive(LinkEvent), bool work(until) that says whether anything is left to do, flush(), finished() and
// noteIdle(seconds).
template <class Task>
void runTask(Task& task, Link& link) {
  const auto sleep = [&](double seconds) {
    const double before = link.now();
    const std::optional<LinkEvent> event = link.wait(seconds);
    task.noteIdle(link.now() - before);
    if (event) task.receive(*event);
    return event.has_value();
  };
  double emptied = link.now();  // since then something may have gathered
  while (!task.finished()) {
    while (auto event = link.poll()) task.receive(*event);
    if (task.finished()) break;
    const bool more = task.work(link.now() + kWorkSlice);
    const bool held = link.now() - emptied < kMostHeldSeconds;
    if (held && (more || sleep(kHoldSeconds))) continue;
    task.flush();
    if (!more) sleep(kPatience);
    emptied = link.now();
  }
  task.flush();
}

}  // namespace rayshade
