// Tiles traced by several threads, in a task that has all that there is to be met.
//
// A job is a tile, or samples that no tile has traced; nothing of it leaves, so nothing is shared but the scene, which nobody writes
// to.  The task's own thread takes work in and sends colours out.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>

#include "pvm/messages/task_context.h"
#include "pvm/trace/epoch_settings.h"
#include "rayshade/trace/render.h"

namespace rayshade {

class TileJobs {
 public:
  TileJobs(TaskContext& context, const EpochSettings& at, LocalSpace& space)
      : context_(context), at_(at), space_(space) {}

  // A new epoch: what was to be done is dropped.  `threads`: at least two, else there are no jobs.  To be called before `at` and
  // the space change, and with the rules when they have; then the host is asked for the first tiles.
  void stop();
  void begin(TaskId host, const SamplingRules& rules, unsigned threads);
  bool active() const { return !tracers_.empty(); }

  void add(const TileWork& message) { add({message.number, {message.tile, {}, {}, {}}}); }
  void add(PrimaryRays&& message) { add({message.firstRecord, {{}, std::move(message.samples), {}, {}}}); }
  // Sends what is done to the host and asks for more.
  void send(TaskId host);

  // What the threads have counted.  Requires that no job is left.
  TraceCounts counts() const;
  std::uint64_t pyramids() const { return pyramids_; }
  std::uint64_t pyramidRays() const { return pyramidRays_; }
  std::size_t left() const { return left_; }

 private:
  struct Done {
    RecordId number = 0;  // of the tile, or of the first sample
    Work work;
  };
  void add(Done&& job);

  TaskContext& context_;
  const EpochSettings& at_;
  LocalSpace& space_;
  std::optional<SamplingRules> rules_;
  std::vector<std::unique_ptr<SampleTracer>> tracers_;  // by thread
  TraceCounts before_;                                  // of epochs that have ended
  std::size_t left_ = 0;                                // jobs that have not been sent
  std::uint64_t pyramids_ = 0, pyramidRays_ = 0;

  std::mutex mutex_;  // of done_
  std::vector<Done> done_;
};

}  // namespace rayshade
