// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/replies.h"

#include <algorithm>

namespace rayshade {

void Replies::begin(TaskId host) {
  host_ = host;
  home_.clear();
  localHits_.clear();
}

void Replies::answer(ReplyTo to, Color color) {
  while (to.task == context_.link.self()) {
    if (to.slot == 0) {
      if (!tiles_.supply(to.record, color)) ++context_.outbox.traffic.refused;
      return;
    }
    const std::uint64_t number = to.record;
    const LocalHit* const hit = localHits_.arrive(number, to.slot, color);
    if (hit == nullptr) {
      ++context_.outbox.traffic.refused;
      return;
    }
    if (hit->missing > 0) return;
    ++combined_;
    color = finish(hit->sum, hit->back, hit->transmitted.value_or(kBlack), hit->reflected.value_or(kBlack),
                   at_.settings);
    to = hit->to;
    localHits_.release(number);
  }
  if (to.task != host_) {
    context_.outbox.post(to.task, Answer{to.record, to.slot, color});
    return;
  }
  home_.push_back({to.record, color});
  if (home_.size() == kMostHome) flush();
}

// In runs of records that follow each other, as they do in a pyramid.
void Replies::flush() {
  std::sort(home_.begin(), home_.end(),
            [](const SampleColor& a, const SampleColor& b) { return a.record < b.record; });
  SampleColors message;
  for (const SampleColor& sample : home_) {
    if (!message.colors.empty() && sample.record != message.first + message.colors.size()) {
      context_.outbox.post(host_, message);
      message.colors.clear();
    }
    if (message.colors.empty()) message.first = sample.record;
    message.colors.push_back(sample.color);
  }
  if (!message.colors.empty()) context_.outbox.post(host_, message);
  home_.clear();
}

}  // namespace rayshade
