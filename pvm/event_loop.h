// The life of every slave task, once: take in what has come, work a little, let out what has gathered, sleep.
//
// Taking in comes first in every turn: PVM's daemons buffer without limit, so they must find it empty.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/inbox.h"

namespace rayshade {

inline constexpr double kWorkSlice = 0.004;  // seconds of work between two looks at the link
inline constexpr double kPatience = 1.0;     // seconds of sleep when nothing comes

// A task has: receive(LinkEvent), bool work(until) that says whether anything is left to do, flush(), finished(),
// noteIdle(seconds).
template <class Task>
void runTask(Task& task, Link& link) {
  while (!task.finished()) {
    while (auto event = link.poll()) task.receive(*event);
    if (task.finished()) break;
    if (task.work(link.now() + kWorkSlice)) {
      task.flush();
      continue;
    }
    task.flush();
    const double before = link.now();
    auto event = link.wait(kPatience);
    task.noteIdle(link.now() - before);
    if (event) task.receive(*event);
  }
  task.flush();
}

}  // namespace rayshade
