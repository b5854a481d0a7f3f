// Tells shade tasks of hits: what is known and what is still to come (Reinhard & Jansen, section 3).
//
// With --shading separate of all hits, as soon as their shadow rays have been traced (rayshade/trace/shade_hits.h); with
// --shading local only of those a part of whose light comes from elsewhere.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/trace/shade_sender.h"
#include "pvm/trace/shadow_bundles.h"

namespace rayshade {

class HitShader {
 public:
  HitShader(const EpochSettings& at, TaskSpace& space, ShadeSender& shades, ShadowBundles& shadows,
            TraceCounts& counts)
      : at_(at), space_(space), shades_(shades), shadows_(shadows), counts_(counts) {}

  // Separate shading of at most kBundleSize hits; to[i]: where the colour of hits[i] goes.  queue(ray, reply) takes the
  // transmitted and reflected rays.
  template <class Queue>
  void shade(std::span<const RayHit> hits, std::span<const ReplyTo> to, Queue queue);
  // A shade task takes the hit over.  Says where the colours of its onward rays go.
  ReplyTo handOver(HitLight& at, const Ray& ray, const ReturnPath& back, const ReplyTo& to);

 private:
  void traceLight(std::span<const RayHit> hits);

  const EpochSettings& at_;
  TaskSpace& space_;
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
    ShadedHit& at = shaded_[i];
    OnwardRays& onward = at.onward;
    const ReplyTo back = handOver(at, *at.ray, returnPath(*at.ray, at.t, onward, at_.settings), to[i]);
    if (onward.transmitted) queue(std::move(*onward.transmitted), {back.task, back.record, kTransmittedSlot});
    if (onward.reflected) queue(std::move(*onward.reflected), {back.task, back.record, kReflectedSlot});
  }
}

}  // namespace rayshade
