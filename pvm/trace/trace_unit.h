// The parts that voxel-trace and pyramid-trace tasks have in common, put together: the way of a bundle through a task.
//
//   rays -> traceRays over `space` -> hits -> `shader` -> light, onward rays          core: rayshade/trace
//                                  -> goes on elsewhere -> `replies`.forward
//   shadow rays that go on -> `shadows` -> other tasks, or `cells` on their way into `cache`
//   colours -> `replies` -> local hits, shade tasks, host
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/trace/hit_shader.h"
#include "pvm/trace/ray_bundle.h"

namespace rayshade {

struct TraceUnit {
  // `share`: null for a task that holds no voxels.
  TraceUnit(TaskContext& context, const VoxelShare* share)
      : context(context),
        cells(context, at, cache),
        space(at, share, cache),
        shades(context, at),
        replies(context, at, shades),
        shadows(context, at, space, cells, counts),
        shader(at, space, replies, shades, shadows, counts) {}
  TraceUnit(const TraceUnit&) = delete;

  // A new epoch of this host: everything that waits is dropped.  `finder`: this task's number among those that find intersections.
  void begin(TaskId host, Configure&& message, std::uint32_t cluster, std::uint32_t finder);
  void setWeights(const Weights& message);

  // Traces at most kBundleSize rays.  What is resolved is shaded, its onward rays go to queue(ray, reply), or answered;
  // goesOn(i, next) takes the others, which are still in their places.
  template <class Queue, class GoesOn>
  void trace(std::span<Ray> rays, std::span<const double> begin, std::span<const ReplyTo> to, Queue queue,
             GoesOn goesOn);

  // What this unit has counted.
  void addTo(Report& report) const;

  TaskContext& context;
  EpochSettings at;
  TraceCounts counts;
  ObjectCache cache;
  CellFetcher cells;
  TaskSpace space;
  ShadeSender shades;
  Replies replies;
  ShadowBundles shadows;
  HitShader shader;
  FoundHits found;  // room
};

template <class Queue, class GoesOn>
void TraceUnit::trace(std::span<Ray> rays, std::span<const double> begin, std::span<const ReplyTo> to,
                      Queue queue, GoesOn goesOn) {
  traceRays(space, rays, begin, found, counts);
  RayHit hits[kBundleSize];
  ReplyTo replyOf[kBundleSize];
  std::size_t count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!found.resolved(i)) {
      goesOn(i, found.next[i]);
    } else if (found.hits[i].found()) {
      hits[count] = {&rays[i], found.hits[i], found.models[i]};
      replyOf[count++] = to[i];
    } else {
      replies.answer(to[i], missed(rays[i], at.settings));
    }
  }
  shader.shade(std::span(hits).first(count), std::span(replyOf).first(count), queue);
}

}  // namespace rayshade
