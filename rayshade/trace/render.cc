// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/render.h"

#include <memory>

#include "rayshade/base/clock.h"
#include "rayshade/base/crew.h"
#include "rayshade/base/interruption.h"

namespace rayshade {
namespace {

constexpr std::size_t kTilesEach = 3;  // of a thread: one that is traced, and others that wait

}  // namespace

Exposure exposureOf(const PictureSpec& picture, std::int32_t frame) {
  const double opens = picture.startTime + frame * picture.frameLength;
  return {opens, opens + std::max(picture.shutter, 0.0), frame};
}

void SampleTracer::trace(std::span<const SampleId> samples, std::span<Color> seen) {
  checkInterruption();
  counts.primaryRays += samples.size();
  primaryRays(request_.view, request_.picture, request_.seed, frame_, samples, rays_);
  tracer_.trace(rays_, {}, seen, none_);
}

TileColors SampleTracer::trace(const SamplingRules& rules, const Tile& tile) {
  TileSampler sampler(rules, tile);
  SampleId samples[kBundleSize];
  Color seen[kBundleSize];
  while (const std::size_t count = sampler.next(samples)) {
    trace(std::span(samples).first(count), seen);
    for (std::size_t i = 0; i < count; ++i) sampler.supply(samples[i], seen[i]);
  }
  return sampler.colors();
}

void SampleTracer::trace(const SamplingRules& rules, Work& work) {
  if (work.samples.empty()) work.tileColors = trace(rules, work.tile);
  work.colors.resize(work.samples.size());
  for (std::size_t first = 0; first < work.samples.size(); first += kBundleSize) {
    const std::size_t count = std::min(kBundleSize, work.samples.size() - first);
    trace(std::span(work.samples).subspan(first, count), std::span(work.colors).subspan(first, count));
  }
}

namespace {

// Tiles, unless there are enough samples that no tile has traced, or no tile may be given.
std::optional<Work> nextWork(Sampler& sampler) {
  Work work;
  if (sampler.missing() < Sampler::kMany) {
    if (const std::optional<Tile> tile = sampler.nextTile()) {
      work.tile = *tile;
      return work;
    }
  }
  work.samples.resize(Sampler::kMany);
  work.samples.resize(sampler.nextSamples(work.samples));
  if (work.samples.empty()) return std::nullopt;
  return work;
}

Event tileEvent(const Tile& tile, std::uint32_t number, double begin, double end) {
  return {nanoseconds(begin),
          nanoseconds(end),
          EventKind::tile,
          0,
          0,
          number,
          static_cast<std::uint32_t>(tile.x),
          static_cast<std::uint64_t>(tile.y)};
}

void supply(Sampler& sampler, const Work& work) {
  if (work.samples.empty()) sampler.supply(work.tile, work.tileColors);
  for (std::size_t i = 0; i < work.samples.size(); ++i) sampler.supply(work.samples[i], work.colors[i]);
}

}  // namespace

FrameResult renderFrame(Scene& scene, const FrameRequest& request, std::int32_t frame, unsigned threads,
                        const std::function<void(const std::vector<Color>&)>& row,
                        const std::function<void(const Sampler&)>& progress, std::span<EventRecord> records) {
  Sampler sampler(request.picture, request.seed, static_cast<std::uint32_t>(frame));
  const SamplingRules& rules = sampler.rules();
  std::vector<std::unique_ptr<SampleTracer>> tracers(threads);  // each made by the thread that uses it
  std::mutex mutex;                                             // of `done`
  std::vector<Work> done, arrived;
  std::vector<Color> finished;
  std::uint32_t number = 0;  // of work
  Crew crew(threads);        // the last one: it ends before what its jobs use

  while (!sampler.finished()) {
    while (crew.left() < kTilesEach * threads) {
      std::optional<Work> next = nextWork(sampler);
      if (!next) break;
      crew.give([&, work = std::move(*next), number = number++](unsigned worker) mutable {
        const double begin = records.empty() ? 0 : steadySeconds();
        if (!tracers[worker])
          tracers[worker] = std::make_unique<SampleTracer>(scene, scene.settings, request, frame);
        tracers[worker]->trace(rules, work);
        if (!records.empty()) records[worker].add(tileEvent(work.tile, number, begin, steadySeconds()));
        const std::lock_guard lock(mutex);
        done.push_back(std::move(work));
      });
    }
    if (!crew.work()) {
      const double begin = records.empty() ? 0 : steadySeconds();
      crew.waitForOne();
      if (!records.empty()) records[0].span(EventKind::idle, begin, steadySeconds());
    }
    crew.rethrow();
    {
      const std::lock_guard lock(mutex);
      arrived.swap(done);
    }
    for (const Work& work : arrived) supply(sampler, work);
    arrived.clear();
    while (sampler.takeRow(finished)) row(finished);
    if (progress) progress(sampler);
  }

  FrameResult result;
  for (const auto& tracer : tracers)
    if (tracer) result.counts = result.counts + tracer->counts;
  result.samples = sampler.counts();
  return result;
}

}  // namespace rayshade
