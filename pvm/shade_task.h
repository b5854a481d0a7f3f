// The shade task (Reinhard & Jansen, figure 3, right).
//
// It is told of intersections, collects the colours of their secondary rays, and when the last has come it shades and
// sends the colour to whoever spawned the ray.  It holds no object data.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/shade_ledger.h"
#include "pvm/task_desk.h"

namespace rayshade {

class ShadeTask {
 public:
  static constexpr double kGather =
      0.0002;  // nobody waits for one colour; measured: a third of the system time, no wall time
  using Accepted = TypeList<Configure, Finish, Ping, Expect, Answer, LightAnswers>;

  explicit ShadeTask(Link& link) : desk_(link) {}

  void receive(const LinkEvent& event) { receiveEvent(*this, desk_, event); }
  bool work(double) { return false; }  // all of it is done as messages come
  void flush() { desk_.flush(); }
  bool finished() const { return desk_.finished; }
  void noteIdle(double seconds) { desk_.idleSeconds += seconds; }

  Epoch epoch() const { return desk_.epoch; }
  void on(TaskId from, Configure message);
  void on(TaskId from, Finish);
  void on(TaskId from, Ping);
  void on(TaskId from, Expect&& message);
  void on(TaskId from, const Answer& message);
  void on(TaskId from, const LightAnswers& message);

 private:
  void act(ShadeLedger::Verdict verdict);

  TaskDesk desk_;
  Setting setting_;
  ShadeLedger ledger_;
  std::uint64_t combined_ = 0;
};

}  // namespace rayshade
