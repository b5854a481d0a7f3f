// Where the colour of a ray goes: to the host, to a task that waits for it, to a tile of this task, or to a hit that it shades.
//
// Colours for this task: in slot 0 those of samples of its tiles (tiles.h), else those of rays that go on from its hits
// (local_hits.h), whoever traced them.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/trace/local_hits.h"
#include "pvm/trace/shade_sender.h"
#include "pvm/trace/tiles.h"

namespace rayshade {

class Replies {
 public:
  Replies(TaskContext& context, const EpochSettings& at, TilesInHand& tiles)
      : context_(context), at_(at), tiles_(tiles) {}

  // A new epoch of this host: whatever waits is dropped.
  void begin(TaskId host);

  // The colour of a ray.  Those of samples gather until flush().  A colour that nobody here waits for is refused and counted.
  void answer(ReplyTo to, Color color);
  // A hit whose light has been added and that waits for rays; where these send their colours.
  ReplyTo await(Color sum, const ReturnPath& back, const ReplyTo& to) {
    return {context_.link.self(), localHits_.add(sum, back, to), kTransmittedSlot};
  }
  // Sends a ray on, to be followed from position `step` of its walk.
  void forward(TaskId task, Ray&& ray, std::uint32_t step, const ReplyTo& to) {
    context_.outbox.post(task, RayTask{std::move(ray), step, to});
  }
  void flush();

  std::size_t waiting() const { return localHits_.size(); }
  std::uint64_t combined() const { return combined_; }  // hits shaded here
  void countCombined(std::uint64_t hits) { combined_ += hits; }

 private:
  static constexpr std::size_t kMostHome = 512;
  struct SampleColor {
    RecordId record;
    Color color;
  };

  TaskContext& context_;
  const EpochSettings& at_;
  TilesInHand& tiles_;
  TaskId host_ = kNobody;
  LocalHits localHits_;
  std::vector<SampleColor> home_;
  std::uint64_t combined_ = 0;
};

}  // namespace rayshade
