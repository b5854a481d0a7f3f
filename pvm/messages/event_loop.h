// The life of every slave task, once: take in what has come, work a little, let out what has gathered, sleep.
//
// Taking in comes first in every turn: PVM's daemons buffer without limit, so they must find it empty.
//
// A full packet goes by itself (outbox.h).  The others do not go as soon as the task has nothing to do: more is likely to
// come, and a packet costs as much as reading a hundred rays.  They go when nothing has come for kHoldSeconds, and at
// the latest after kMostHeldSeconds, for somebody may wait for them.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include "pvm/messages/inbox.h"

namespace rayshade {

inline constexpr double kWorkSlice = 0.004;  // seconds of work between two looks at the link
inline constexpr double kHoldSeconds = 0.0005;
inline constexpr double kMostHeldSeconds = 0.004;
inline constexpr double kPatience = 1.0;  // seconds of sleep when nothing comes

// A task has: receive(LinkEvent), bool work(until) that says whether anything is left to do, flush(), finished() and
// noteIdle(seconds).
template <class Task>
class TaskLoop {
 public:
  TaskLoop(Task& task, Link& link) : task_(task), link_(link), emptied_(link.now()) {}

  // Takes one event in, or works a little.  Answers how long the task sleeps then unless something comes; 0: not at all.
  double turn() {
    if (const std::optional<LinkEvent> event = link_.poll()) {
      receive(*event);
      return 0;
    }
    const Sleep slept = std::exchange(sleep_, Sleep::none);
    if (slept == Sleep::holding) return letOut(false);  // nothing has come
    if (slept == Sleep::resting) emptied_ = link_.now();
    const bool more = task_.work(link_.now() + kWorkSlice);
    if (link_.now() - emptied_ >= kMostHeldSeconds) return letOut(more);
    if (more) return 0;
    sleep_ = Sleep::holding;
    return kHoldSeconds;
  }
  void receive(const LinkEvent& event) {
    if (sleep_ == Sleep::resting) emptied_ = link_.now();
    sleep_ = Sleep::none;
    task_.receive(event);
  }

 private:
  enum class Sleep : std::uint8_t { none, holding, resting };

  double letOut(bool more) {
    task_.flush();
    emptied_ = link_.now();
    if (more) return 0;
    sleep_ = Sleep::resting;
    return kPatience;
  }

  Task& task_;
  Link& link_;
  double emptied_;  // since then something may have gathered
  Sleep sleep_ = Sleep::none;
};

template <class Task>
void runTask(Task& task, Link& link) {
  TaskLoop<Task> loop(task, link);
  while (!task.finished()) {
    const double patience = loop.turn();
    if (patience == 0 || task.finished()) continue;
    const double before = link.now();
    const std::optional<LinkEvent> event = link.wait(patience);
    task.noteIdle(link.now() - before);
    if (event) loop.receive(*event);
  }
  task.flush();
}

}  // namespace rayshade
