// The samples that are on their way, by serial number.
//
// Serial numbers rise by one, so a sample's place follows from its number: a ring, no hash.  Its length is that from the
// oldest sample on its way to the newest; whoever adds samples bounds it.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "pvm/messages/all.h"

namespace rayshade {

class InFlight {
 public:
  // The number that the next sample will get.
  RecordId next() const { return first_ + ring_.size(); }
  void add(const SampleId& sample) {
    ring_.push_back(sample);
    ++count_;
  }

  // The sample of that number, which is now home; nothing if it is not on its way.
  std::optional<SampleId> take(RecordId number) {
    if (number < first_ || number - first_ >= ring_.size()) return std::nullopt;
    const std::optional<SampleId> sample = std::exchange(ring_[number - first_], std::nullopt);
    if (sample) --count_;
    while (!ring_.empty() && !ring_.front()) {
      ring_.pop_front();
      ++first_;
    }
    return sample;
  }

  // All of them, oldest first; then none is on its way.
  std::vector<SampleId> takeAll() {
    std::vector<SampleId> samples;
    for (const std::optional<SampleId>& sample : ring_)
      if (sample) samples.push_back(*sample);
    first_ += ring_.size();
    ring_.clear();
    count_ = 0;
    return samples;
  }

  std::size_t size() const { return count_; }
  std::size_t span() const { return ring_.size(); }

 private:
  RecordId first_ = 0;  // number of the front
  std::deque<std::optional<SampleId>> ring_;
  std::size_t count_ = 0;
};

}  // namespace rayshade
