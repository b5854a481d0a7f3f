// The parts that voxel-trace and pyramid-trace tasks have in common, put together: the way of a bundle through a task.
//
//   rays -> `tracer` over `space` -> colours -> `replies` -> tiles, hits of this task, shade tasks, host
//                                 -> open ends: rays that go on elsewhere, and hits that wait for them
//   shadow rays that go on -> `shadows` -> other tasks, or `cells` on their way into `cache`
//
// With --shading separate hits are not followed here: `shader` tells a shade task of each, as in Reinhard & Jansen, figure 3.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/trace/hit_shader.h"
#include "pvm/trace/image_copies.h"
#include "pvm/trace/ray_bundle.h"
#include "pvm/trace/replies.h"
#include "rayshade/trace/tracer.h"

namespace rayshade {

struct TraceUnit {
  // Tiles in hand and asked for: some are traced while others wait for cells or colours.
  static constexpr std::size_t kAhead = 4;

  // `share`: null for a task that holds no voxels.
  TraceUnit(TaskContext& context, const VoxelShare* share)
      : context(context),
        cells(context, at, cache),
        space(at, share, cache),
        shades(context, at),
        replies(context, at, tiles),
        shadows(context, at, space, cells, counts),
        shader(at, space, shades, shadows, counts),
        tracer(space, at.settings, counts) {}
  TraceUnit(const TraceUnit&) = delete;

  // A new epoch of this host: everything that waits is dropped.  `finder`: this task's number among those that find intersections.
  void begin(TaskId host, Configure&& message, std::uint32_t cluster, std::uint32_t finder);
  void setWeights(const Weights& message);

  // Traces at most kBundleSize rays and answers what is finished here.  queue(ray, reply) takes rays that begin at hits and are
  // not followed at once.
  template <class Queue>
  void trace(std::span<Ray> rays, std::span<const double> begin, std::span<const ReplyTo> to, Queue queue) {
    if (at.policy.shadeLocally) {
      traceTrees(rays, begin, to);
    } else {
      traceOnce(rays, begin, to, queue);
    }
  }

  // A cell is here: the rays that have waited for it, to be traced before another one comes and this one goes.
  RayBundle arrive(CellId cell);

  // Traces the next samples of a tile, if any can be traced now.  False: none can.
  template <class Queue>
  bool traceTile(Queue queue);
  // Asks the host for tiles until there are so many in hand or asked for.
  void wantTiles(TaskId host, std::size_t most = kAhead);
  // What was asked for has come: a tile, or samples in its place.
  void noteWork() { asked_ -= asked_ > 0; }
  // Sends what has become of tiles to the host.
  void sendTiles(TaskId host);

  // Gives a cell of another task, which is in the cache, to whom that task says; if it is not here any more the question goes back.
  // What its owner would not say is refused and counted.
  void giveOn(const CellWanted& message);

  // What this unit has counted.
  void addTo(Report& report) const;

  TaskContext& context;
  EpochSettings at;
  TraceCounts counts;
  ImageCopies images;
  ObjectCache cache;
  CellFetcher cells;
  TaskSpace space;
  TilesInHand tiles;
  std::optional<SamplingRules> rules;  // of the picture of the epoch
  ShadeSender shades;
  Replies replies;
  ShadowBundles shadows;
  HitShader shader;
  Tracer tracer;
  bool fetchesForRays = false;  // not only for shadow rays
  std::uint64_t pyramids = 0, pyramidRays = 0, forwardedRays = 0, cellsServed = 0;

 private:
  void traceTrees(std::span<Ray> rays, std::span<const double> begin, std::span<const ReplyTo> to);
  template <class Queue>
  void traceOnce(std::span<Ray> rays, std::span<const double> begin, std::span<const ReplyTo> to,
                 Queue queue);
  void goOn(Ray&& ray, const NextBlock& next, const ReplyTo& to);

  std::size_t asked_ = 0;         // tiles
  std::uint64_t travelling_ = 0;  // rays that went on elsewhere
  std::unordered_map<std::uint32_t, RayBundle> waitingForCell_;
  // Room that is used again.
  FoundHits found_;
  OpenEnds open_;
  std::vector<ReplyTo> replyOf_;  // of open hits
  std::vector<Ray> primaries_;
};

template <class Queue>
void TraceUnit::traceOnce(std::span<Ray> rays, std::span<const double> begin, std::span<const ReplyTo> to,
                          Queue queue) {
  traceRays(space, rays, begin, found_, counts);
  RayHit hits[kBundleSize];
  ReplyTo replyOf[kBundleSize];
  std::size_t count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!found_.resolved(i)) {
      goOn(std::move(rays[i]), found_.next[i], to[i]);
    } else if (found_.hits[i].found()) {
      hits[count] = {&rays[i], found_.hits[i], found_.models[i]};
      replyOf[count++] = to[i];
    } else {
      replies.answer(to[i], missed(rays[i], at.settings));
    }
  }
  shader.shade(std::span(hits).first(count), std::span(replyOf).first(count), queue);
}

template <class Queue>
bool TraceUnit::traceTile(Queue queue) {
  SampleId samples[kBundleSize];
  RecordId records[kBundleSize];
  const std::size_t count = tiles.next(samples, records);
  if (count == 0) return false;
  primaryRays(at.request.view, at.request.picture, at.request.seed, at.exposure.frame,
              std::span(samples).first(count), primaries_);
  counts.primaryRays += count;
  ReplyTo to[kBundleSize];
  for (std::size_t i = 0; i < count; ++i) to[i] = {context.link.self(), records[i], 0};
  const std::uint64_t before = travelling_;
  trace(primaries_, {}, std::span(to).first(count), queue);
  forwardedRays += travelling_ - before;
  return true;
}

}  // namespace rayshade
