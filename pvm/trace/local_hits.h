// Hits that are being shaded by the task that found them.
//
// Their lights have been added; what is awaited are the colours of the rays that go on from them, which are with the same
// task.  As soon as one of these rays must leave, its hit goes over to a shade task, which collects what is still to come
// (Reinhard & Jansen, section 3); so a shade task is asked where colours come from several places, and only there.
// docs/decisions/0016-shading-where-it-is-found.md
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
  int rays = 0;                                 // of this task, that will bring a colour
  ReplyTo there;                                // once it has gone over: where they send it
};

class LocalHits {
 public:
  std::uint64_t add(Color sum, const ReturnPath& back, const ReplyTo& to) {
    if (free_.empty()) {
      free_.push_back(hits_.size());
      hits_.emplace_back();
    }
    const std::uint64_t number = free_.back();
    free_.pop_back();
    hits_[number] = {sum, back, to, {}, {}, back.transmitted + back.reflected, {}};
    return number;
  }
  // Requires a number of add() that has rays left.
  LocalHit& operator[](std::uint64_t number) { return hits_[number]; }
  // One of its rays has come back or left; the last one ends the hit.
  void forgetRay(std::uint64_t number) {
    if (--hits_[number].rays == 0) free_.push_back(number);
  }
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
