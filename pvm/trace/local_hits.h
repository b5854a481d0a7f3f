// Hits that are being shaded by the task that found them.
//
// Their lights have been added; what is awaited are the colours of the rays that go on from them, whether these stay with the task or
// travel.  So a shade task is asked only where light comes from elsewhere (Reinhard & Jansen, section 3, and
// docs/decisions/0016-shading-where-it-is-found.md).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>

#include "pvm/messages/all.h"

namespace rayshade {

struct LocalHit {
  Color sum;  // of the lights
  ReturnPath back;
  ReplyTo to;                                   // where its own colour goes
  std::optional<Color> transmitted, reflected;  // once they have come
  int missing = 0;                              // colours; 0: nobody waits here
};

class LocalHits {
 public:
  // Requires that `back` waits for something.
  std::uint64_t add(Color sum, const ReturnPath& back, const ReplyTo& to) {
    if (free_.empty()) {
      free_.push_back(hits_.size());
      hits_.emplace_back();
    }
    const std::uint64_t number = free_.back();
    free_.pop_back();
    hits_[number] = {sum, back, to, {}, {}, back.transmitted + back.reflected};
    return number;
  }
  // The colour of a ray that goes on from a hit.  Answers with the hit, which is complete when nothing is missing and then keeps its
  // place until release(); null: nothing is awaited there.
  const LocalHit* arrive(std::uint64_t number, Slot slot, Color color) {
    if (number >= hits_.size() || (slot != kTransmittedSlot && slot != kReflectedSlot)) return nullptr;
    LocalHit& hit = hits_[number];
    const bool transmitted = slot == kTransmittedSlot;
    std::optional<Color>& place = transmitted ? hit.transmitted : hit.reflected;
    if (hit.missing == 0 || place || !(transmitted ? hit.back.transmitted : hit.back.reflected))
      return nullptr;
    place = color;
    --hit.missing;
    return &hit;
  }
  // Requires a hit that is complete.
  void release(std::uint64_t number) { free_.push_back(number); }
  std::size_t size() const { return hits_.size() - free_.size(); }
  void clear() {
    hits_.clear();
    free_.clear();
  }

 private:
  std::deque<LocalHit> hits_;
  std::vector<std::uint64_t> free_;  // numbers that can be used again
};

}  // namespace rayshade
