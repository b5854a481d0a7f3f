// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/simulation/simulated_task.h"

#include "pvm/messages/event_loop.h"
#include "pvm/shade/shade_task.h"
#include "pvm/trace/pyramid_task.h"
#include "pvm/trace/voxel_task.h"

namespace rayshade {
namespace {

template <class Task>
class Simulated final : public SimulatedTask {
 public:
  explicit Simulated(Link& link) : task_(link), loop_(task_, link) {}
  void receive(const LinkEvent& event) override { task_.receive(event); }
  bool work(double until) override { return task_.work(until); }
  void flush() override { task_.flush(); }
  bool finished() const override { return task_.finished(); }
  void noteIdle(double seconds) override { task_.noteIdle(seconds); }
  double turn() override { return loop_.turn(); }
  Report counted() const override { return task_.counted(); }
  std::uint64_t heldBytes() const override { return task_.heldBytes(); }

 private:
  Task task_;
  TaskLoop<Task> loop_;
};

}  // namespace

std::unique_ptr<SimulatedTask> makeTask(Role role, Link& link) {
  switch (role) {
    case Role::voxelTrace:
      return std::make_unique<Simulated<VoxelTask>>(link);
    case Role::pyramidTrace:
      return std::make_unique<Simulated<PyramidTask>>(link);
    case Role::shade:
      return std::make_unique<Simulated<ShadeTask>>(link);
    case Role::host:
      break;
  }
  return nullptr;
}

}  // namespace rayshade
