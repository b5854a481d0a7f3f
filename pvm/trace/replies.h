// Where the colour of a ray goes: to the host, to a shade task, to a tile of this task, or to a hit that it shades itself.
//
// Colours for this task: in slot 0 those of samples of its tiles (tiles.h), else those of rays that go on from its hits.
// A hit stays with the task that found it as long as all rays that go on from it do (local_hits.h).  When one of them leaves,
// the hit is promoted: a shade task takes it over, and with it go those that wait for it.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/trace/local_hits.h"
#include "pvm/trace/shade_sender.h"
#include "pvm/trace/tiles.h"

namespace rayshade {

class Replies {
 public:
  Replies(TaskContext& context, const EpochSettings& at, ShadeSender& shades, TilesInHand& tiles)
      : context_(context), at_(at), shades_(shades), tiles_(tiles) {}

  // A new epoch of this host: whatever waits is dropped.
  void begin(TaskId host);

  // The colour of a ray.  Those of samples gather until flush().
  void answer(ReplyTo to, Color color);
  // A hit whose light has been added and that waits for rays of this task; where these send their colours.
  ReplyTo await(Color sum, const ReturnPath& back, const ReplyTo& to) {
    return {context_.link.self(), localHits_.add(sum, back, to), kTransmittedSlot};
  }
  // Sends a ray of this task on, to be followed from position `step` of its walk.
  void forward(TaskId task, Ray&& ray, std::uint32_t step, const ReplyTo& to) {
    context_.outbox.post(task, RayTask{std::move(ray), step, externalReply(to)});
  }
  // Where others send the colour of a ray whose colour was to come here.
  ReplyTo externalReply(ReplyTo to);
  void flush();

  std::uint64_t combined() const { return combined_; }  // hits shaded here
  void countCombined(std::uint64_t hits) { combined_ += hits; }

 private:
  static constexpr std::size_t kMostHome = 512;
  struct SampleColor {
    RecordId record;
    Color color;
  };
  ReplyTo promote(LocalHit& hit);

  TaskContext& context_;
  const EpochSettings& at_;
  ShadeSender& shades_;
  TilesInHand& tiles_;
  TaskId host_ = kNobody;
  LocalHits localHits_;
  std::vector<SampleColor> home_;
  std::uint64_t combined_ = 0;
  Expect expect_;  // room
};

}  // namespace rayshade
