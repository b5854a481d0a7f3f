// What is on its way, by serial number.
//
// Serial numbers rise by one, so a thing's place follows from its number: a ring, no hash.  Its length is that from the
// oldest thing on its way to the newest; whoever adds things bounds it.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "pvm/messages/all.h"

namespace rayshade {

template <class Thing>
class InFlight {
 public:
  // The number that the next one will get.
  RecordId next() const { return first_ + ring_.size(); }
  void add(Thing thing) {
    ring_.push_back(std::move(thing));
    ++count_;
  }

  // The one of that number, which is now home; nothing if it is not on its way.
  std::optional<Thing> take(RecordId number) {
    if (number < first_ || number - first_ >= ring_.size()) return std::nullopt;
    std::optional<Thing> thing = std::exchange(ring_[number - first_], std::nullopt);
    if (thing) --count_;
    while (!ring_.empty() && !ring_.front()) {
      ring_.pop_front();
      ++first_;
    }
    return thing;
  }

  // All of them, oldest first; then none is on its way.
  std::vector<Thing> takeAll() {
    std::vector<Thing> things;
    for (std::optional<Thing>& thing : ring_)
      if (thing) things.push_back(std::move(*thing));
    first_ += ring_.size();
    ring_.clear();
    count_ = 0;
    return things;
  }

  std::size_t size() const { return count_; }
  std::size_t span() const { return ring_.size(); }

 private:
  RecordId first_ = 0;  // number of the front
  std::deque<std::optional<Thing>> ring_;
  std::size_t count_ = 0;
};

}  // namespace rayshade
