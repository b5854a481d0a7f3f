// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/hit_shader.h"

#include <algorithm>

namespace rayshade {

void HitShader::traceLight(std::span<const RayHit> hits) {
  if (hits.empty()) return;
  shadeHits(space_, hits, at_.settings, {.sums = false, .records = true}, shaded_, room_, counts_);
}

ReplyTo HitShader::handOver(HitLight& at, const Ray& ray, const ReturnPath& back, const ReplyTo& to) {
  expect_.to = to;
  expect_.hit = describe(ray, back, at.point, at.visibility);
  expect_.gathered.light = at.light;
  expect_.pending.clear();
  for (const PendingShadow& pending : at.pending) expect_.pending.push_back(static_cast<Slot>(pending.row));
  std::sort(expect_.pending.begin(), expect_.pending.end());
  const bool waits = back.transmitted || back.reflected || !at.pending.empty();
  const ReplyTo there = shades_.send(expect_, waits);
  if (!at.pending.empty())
    shadows_.sendOn({there.task, there.record, ray.moment, ray.sample, ray.key}, at.pending);
  return there;
}

}  // namespace rayshade
