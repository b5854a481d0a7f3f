// The shade task (Reinhard & Jansen, figure 3, right).
//
// It is told of intersections, collects the colours of their secondary rays, and when the last has come it shades and
// sends the colour to whoever spawned the ray.  It holds no object data.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/messages/task_context.h"
#include "pvm/shade/shade_ledger.h"

namespace rayshade {

class ShadeTask {
 public:
  using Accepted = TypeList<Configure, Finish, Ping, Observe, Expect, Answer, LightAnswers>;

  explicit ShadeTask(Link& link) : context_(link) {}

  void receive(const LinkEvent& event) {
    const TaskContext::Doing doing(context_, EventKind::shade);
    receiveEvent(*this, context_, event);
  }
  bool work(double) { return false; }  // all of it is done as messages come
  void flush() { context_.flush(); }
  bool finished() const { return context_.finished; }
  std::uint64_t waiting() const { return ledger_.open(); }
  void noteIdle(double seconds) { context_.noteIdle(seconds, waiting()); }

  Report counted() const;                        // so far
  std::uint64_t heldBytes() const { return 0; }  // of the model

  Epoch epoch() const { return context_.epoch; }
  void on(TaskId from, Configure message);
  void on(TaskId from, Finish);
  void on(TaskId from, Ping);
  void on(TaskId, const Observe& message) { context_.observe(message); }
  void on(TaskId from, Expect&& message);
  void on(TaskId from, const Answer& message);
  void on(TaskId from, const LightAnswers& message);

 private:
  void act(ShadeLedger::Verdict verdict);

  TaskContext context_;
  SceneSettings settings_;
  ShadeLedger ledger_;
  std::uint64_t combined_ = 0;
};

}  // namespace rayshade
