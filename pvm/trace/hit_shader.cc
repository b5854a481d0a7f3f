// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/hit_shader.h"

#include <algorithm>

namespace rayshade {

void HitShader::traceLight(std::span<const RayHit> hits) {
  if (hits.empty()) return;
  shadeHits(space_, hits, at_.settings, {.sums = at_.policy.shadeAtOnce, .records = true}, shaded_, room_,
            counts_);
}

// Shades a hit, or what can be shaded of it here, or tells a shade task of it.  Says where the colours of its onward rays go, if
// there are any.
std::optional<ReplyTo> HitShader::finishHit(ShadedHit& at, const ReplyTo& to) {
  const bool onward = at.onward.transmitted || at.onward.reflected;
  if (at_.policy.shadeAtOnce && at.pending.empty()) {
    const ReturnPath back = returnPath(*at.ray, at.t, at.onward, at_.settings);
    if (onward) return replies_.await(at.sum, back, to);
    replies_.countCombined();
    replies_.answer(to, finish(at.sum, back, {}, {}, at_.settings));
    return std::nullopt;
  }
  expect_.to = replies_.externalReply(to);
  expect_.hit = describe(*at.ray, at.t, at.point, at.onward, at.visibility, at_.settings);
  expect_.gathered.light = at.light;
  expect_.pending.clear();
  for (const PendingShadow& pending : at.pending) expect_.pending.push_back(static_cast<Slot>(pending.row));
  std::sort(expect_.pending.begin(), expect_.pending.end());
  const ReplyTo there = shades_.send(expect_, onward || !at.pending.empty());
  if (!at.pending.empty())
    shadows_.sendOn({there.task, there.record, at.ray->moment, at.ray->sample, at.ray->key}, at.pending);
  return onward ? std::optional(there) : std::nullopt;
}

}  // namespace rayshade
