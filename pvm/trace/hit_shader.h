// Shades hits where they were found, or tells a shade task of them.
//
// Light is traced first (rayshade/trace/shade_hits.h).  With --shading local a hit that has all of its light is finished here;
// otherwise, and whenever a shadow ray goes on elsewhere, a shade task is told what is known and what is still to come
// (Reinhard & Jansen, section 3).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/trace/replies.h"
#include "pvm/trace/shadow_bundles.h"

namespace rayshade {

class HitShader {
 public:
  HitShader(const EpochSettings& at, TaskSpace& space, Replies& replies, ShadeSender& shades,
            ShadowBundles& shadows, TraceCounts& counts)
      : at_(at), space_(space), replies_(replies), shades_(shades), shadows_(shadows), counts_(counts) {}

  // At most kBundleSize rays of this task have hit; to[i]: where the colour of hits[i] goes.  queue(ray, reply) takes the
  // transmitted and reflected rays.
  template <class Queue>
  void shade(std::span<const RayHit> hits, std::span<const ReplyTo> to, Queue queue);

 private:
  void traceLight(std::span<const RayHit> hits);
  std::optional<ReplyTo> finishHit(ShadedHit& at, const ReplyTo& to);

  const EpochSettings& at_;
  TaskSpace& space_;
  Replies& replies_;
  ShadeSender& shades_;
  ShadowBundles& shadows_;
  TraceCounts& counts_;
  // Room that is used again.
  std::array<ShadedHit, kBundleSize> shaded_;
  ShadingRoom room_;
  Expect expect_;
};

template <class Queue>
void HitShader::shade(std::span<const RayHit> hits, std::span<const ReplyTo> to, Queue queue) {
  traceLight(hits);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const std::optional<ReplyTo> back = finishHit(shaded_[i], to[i]);
    if (!back) continue;
    OnwardRays& onward = shaded_[i].onward;
    if (onward.transmitted)
      queue(std::move(*onward.transmitted), ReplyTo{back->task, back->record, kTransmittedSlot});
    if (onward.reflected)
      queue(std::move(*onward.reflected), ReplyTo{back->task, back->record, kReflectedSlot});
  }
}

}  // namespace rayshade
