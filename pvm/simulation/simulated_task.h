// A slave task, as a machine of this process moves it.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "pvm/messages/control.h"

namespace rayshade {

class SimulatedTask {
 public:
  virtual ~SimulatedTask() = default;
  // What the task has; see event_loop.h.
  virtual void receive(const LinkEvent& event) = 0;
  virtual bool work(double until) = 0;
  virtual void flush() = 0;
  virtual bool finished() const = 0;
  virtual void noteIdle(double seconds) = 0;
  // The next turn of its loop; how long it sleeps then, at most.
  virtual double turn() = 0;
  // What it has counted so far.
  virtual Report counted() const = 0;
  // Of the model, and at most in its cache.
  virtual std::uint64_t heldBytes() const = 0;
};

// Null: no slave has this role.
std::unique_ptr<SimulatedTask> makeTask(Role role, Link& link);

}  // namespace rayshade
