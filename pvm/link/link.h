// All that a task can do to the world: send, poll, wait, look at the clock.
//
// Two implementations stand behind it: PvmLink (real PVM 3) and the simulated machine (all tasks in one process,
// seeded delivery, deaths).  A task cannot tell them apart.  What is promised, by both:
//   - packets from one task to another arrive in the order in which they were sent, or not at all;
//   - nothing is promised about packets of different senders: a child can overtake its parent;
//   - a send never fails: a packet to a dead task vanishes; a dying task may lose what it had sent;
//   - a death that is watched is told once, after the last packet of the dead that still arrives was delivered or lost.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rayshade/base/archive.h"

namespace rayshade {

// The name of a running task (PVM's tid); a task that takes the place of a dead one has another.
enum class TaskId : std::int32_t {};
inline constexpr TaskId kNobody{0};

enum class Role : std::uint8_t { host, voxelTrace, pyramidTrace, shade };

// The names of the programs, and so of the roles: rayshade-host, rayshade-voxel-trace, ...
constexpr const char* programName(Role role) {
  switch (role) {
    case Role::host:
      return "rayshade-host";
    case Role::voxelTrace:
      return "rayshade-voxel-trace";
    case Role::pyramidTrace:
      return "rayshade-pyramid-trace";
    case Role::shade:
      return "rayshade-shade";
  }
  return "";
}

// Of a role alone: voxel-trace.
inline std::string roleName(Role role) { return std::string(programName(role)).substr(9); }

// What comes in.
struct LinkEvent {
  enum class Kind : std::uint8_t { packet, taskExit, hostExit, hostJoined, jobDone } kind = Kind::packet;
  TaskId task = kNobody;  // the sender, or the task that is gone
  std::string host;       // of hostExit and hostJoined
  Bytes bytes;            // of a packet
};

// What a task has taken of its machine so far.
struct Usage {
  double cpuSeconds = 0;
  std::uint64_t peakMemory = 0;  // bytes
};

class Link {
 public:
  virtual ~Link() = default;

  virtual TaskId self() const = 0;
  virtual TaskId parent() const = 0;  // who spawned this task; kNobody for the first one
  virtual void send(TaskId to, std::span<const std::byte> packet) = 0;
  virtual std::optional<LinkEvent> poll() = 0;                // what is there now, without waiting
  virtual std::optional<LinkEvent> wait(double seconds) = 0;  // nothing: the time is over
  virtual void watch(TaskId task) = 0;                        // a taskExit event will tell of its death
  virtual double now() const = 0;                             // seconds of a clock that only goes forward

  virtual Usage usage() const = 0;

  // ---- threads of this task, beside the one that calls

  virtual unsigned cores() const = 0;  // of its machine

  // Work of one thread: `worker` is 0 .. threads - 1, and no two jobs of one worker are done at a time.
  using Job = std::function<void(unsigned worker)>;
  // Starts so many threads; ends those that there were, when the jobs that have begun are done: the others are dropped.
  virtual void useThreads(unsigned threads) = 0;
  // Requires threads.  A jobDone event tells of one or several jobs that are done; what a job throws is thrown there.
  virtual void run(Job job) = 0;
};

// A machine that tasks can be placed on.
struct HostInfo {
  std::string name;
  int speed = 1000;  // relative, from the host file's sp=
};

struct Spawned {
  TaskId task = kNobody;  // kNobody: it could not be started
  std::string problem;    // why
};

// What the host task can do besides.
class Machine : public Link {
 public:
  virtual std::vector<HostInfo> hosts() = 0;  // the machines that are there now, the own one first
  virtual Spawned spawn(Role role, const std::string& host) = 0;
  virtual void kill(TaskId task) = 0;  // a task that hangs
};

}  // namespace rayshade
