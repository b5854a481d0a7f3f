// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/tile_jobs.h"

namespace rayshade {
namespace {

constexpr unsigned kAhead = 3;  // tiles for each thread

}  // namespace

void TileJobs::stop() {
  if (!active()) return;
  context_.useThreads(0);
  before_ = counts();
  tracers_.clear();
  done_.clear();
  left_ = 0;
}

void TileJobs::begin(TaskId host, const SamplingRules& rules, unsigned threads) {
  rules_ = rules;
  context_.useThreads(threads);
  for (unsigned i = 0; i < threads; ++i)
    tracers_.push_back(std::make_unique<SampleTracer>(space_, at_.settings, at_.request, at_.exposure.frame));
  for (unsigned i = 0; i < kAhead * threads; ++i) context_.outbox.post(host, PyramidWanted{});
}

void TileJobs::add(Done&& job) {
  ++left_;
  const RecordId number = job.number;
  const Tile tile = job.work.tile;
  context_.run(
      [this, job = std::move(job)](unsigned worker) mutable {
        tracers_[worker]->trace(*rules_, job.work);
        const std::lock_guard lock(mutex_);
        done_.push_back(std::move(job));
      },
      number, tile.x, tile.y);
}

void TileJobs::send(TaskId host) {
  std::vector<Done> done;
  {
    const std::lock_guard lock(mutex_);
    done.swap(done_);
  }
  left_ -= done.size();
  for (Done& job : done) {
    if (job.work.samples.empty()) {
      ++pyramids_;
      pyramidRays_ += job.work.tileColors.samples;
      context_.outbox.post(host,
                           TileDone{static_cast<std::uint32_t>(job.number), std::move(job.work.tileColors)});
    } else {
      context_.outbox.post(host, SampleColors{job.number, std::move(job.work.colors)});
    }
    context_.outbox.post(host, PyramidWanted{});
  }
}

TraceCounts TileJobs::counts() const {
  TraceCounts sum = before_;
  for (const auto& tracer : tracers_) sum = sum + tracer->counts;
  return sum;
}

}  // namespace rayshade
