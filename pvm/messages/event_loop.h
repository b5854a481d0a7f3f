// The life of every slave task, once: take in what has come, work a little, let out what has gathered, sleep.
//
// Taking in comes first in every turn: PVM's daemons buffer without limit, so they must find it empty.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/messages/inbox.h"

namespace rayshade {

inline constexpr double kWorkSlice = 0.004;  // seconds of work between two looks at the link
inline constexpr double kPatience = 1.0;     // seconds of sleep when nothing comes
// What has gathered is held back no longer than this many times Task::kHoldSeconds.
inline constexpr double kMostGathers = 10;

// A task has: receive(LinkEvent), bool work(until) that says whether anything is left to do, flush(), finished(),
// noteIdle(seconds), and kHoldSeconds: seconds for which it holds back what has gathered when it has nothing to do, because more
// is likely to come and a packet costs as much as reading a hundred rays; 0: not at all.
template <class Task>
void runTask(Task& task, Link& link) {
  double sent = link.now();
  while (!task.finished()) {
    while (auto event = link.poll()) task.receive(*event);
    if (task.finished()) break;
    const bool more = task.work(link.now() + kWorkSlice);
    double before = link.now();
    if (!more && before - sent < kMostGathers * Task::kHoldSeconds) {
      auto event = link.wait(Task::kHoldSeconds);
      task.noteIdle(link.now() - before);
      if (event) {
        task.receive(*event);
        continue;
      }
    }
    task.flush();
    before = sent = link.now();
    if (more) continue;
    auto event = link.wait(kPatience);
    task.noteIdle(link.now() - before);
    if (event) task.receive(*event);
  }
  task.flush();
}

}  // namespace rayshade
