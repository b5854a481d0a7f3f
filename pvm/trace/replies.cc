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
    LocalHit& hit = localHits_[to.record];
    const std::uint64_t number = to.record;
    if (hit.there.task != kNobody) {
      to = {hit.there.task, hit.there.record, to.slot};
      localHits_.forgetRay(number);
      break;
    }
    (to.slot == kTransmittedSlot ? hit.transmitted : hit.reflected) = color;
    if (hit.rays > 1) {
      --hit.rays;
      return;
    }
    ++combined_;
    color = finish(hit.sum, hit.back, hit.transmitted.value_or(kBlack), hit.reflected.value_or(kBlack),
                   at_.settings);
    to = hit.to;
    localHits_.forgetRay(number);
  }
  if (to.task != host_) {
    context_.outbox.post(to.task, Answer{to.record, to.slot, color});
    return;
  }
  home_.push_back({to.record, color});
  if (home_.size() == kMostHome) flush();
}

ReplyTo Replies::externalReply(ReplyTo to) {
  if (to.task != context_.link.self() || to.slot == 0) return to;
  LocalHit& hit = localHits_[to.record];
  if (hit.there.task == kNobody) hit.there = promote(hit);
  const ReplyTo there{hit.there.task, hit.there.record, to.slot};
  localHits_.forgetRay(to.record);
  return there;
}

// With it go those that wait for it: their colours come from outside now.
ReplyTo Replies::promote(LocalHit& hit) {
  const ReplyTo to = externalReply(hit.to);
  expect_.hit = afterLights(hit.sum, hit.back);
  expect_.to = to;
  expect_.gathered = {};
  expect_.pending.clear();
  const ReplyTo there = shades_.send(expect_, true);
  if (hit.transmitted)
    context_.outbox.post(there.task, Answer{there.record, kTransmittedSlot, *hit.transmitted});
  if (hit.reflected) context_.outbox.post(there.task, Answer{there.record, kReflectedSlot, *hit.reflected});
  return there;
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
