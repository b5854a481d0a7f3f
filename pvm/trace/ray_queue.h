// What waits in a voxel-trace task: samples whose rays are not made yet, rays by depth, shadow rays of others.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>

#include "pvm/trace/ray_bundle.h"
#include "pvm/trace/shadow_bundles.h"

namespace rayshade {

// Samples, first in, first out.
class SampleQueue {
 public:
  std::uint64_t waiting() const { return waiting_; }
  void add(PrimaryRays&& work) {
    waiting_ += work.samples.size();
    runs_.push_back({std::move(work), 0});
  }
  // Calls use(sample, record) for the next `most` samples, or all.
  template <class Use>
  void take(std::size_t most, Use&& use) {
    for (; most > 0 && !runs_.empty(); --most) {
      Run& run = runs_.front();
      use(run.work.samples[run.next], run.work.firstRecord + run.next);
      --waiting_;
      if (++run.next == run.work.samples.size()) runs_.pop_front();
    }
  }
  void clear() {
    runs_.clear();
    waiting_ = 0;
  }

 private:
  struct Run {
    PrimaryRays work;
    std::size_t next = 0;  // sample
  };
  std::deque<Run> runs_;
  std::uint64_t waiting_ = 0;
};

// Rays, deepest first; those of one depth last in, first out, so that neighbours stay together.
class RayQueue {
 public:
  std::uint64_t size() const { return size_; }
  void add(Ray&& ray, double begin, const ReplyTo& to) {
    const auto depth = static_cast<std::size_t>(std::clamp(ray.depth, 0, kDepths - 1));
    if (depth >= byDepth_.size()) byDepth_.resize(depth + 1);
    byDepth_[depth].add(std::move(ray), begin, to);
    ++size_;
  }
  // Moves rays of one depth, at most `most`, to `into`.  Requires that there are any.
  void takeDeepest(std::size_t most, RayBundle& into) {
    std::size_t depth = byDepth_.size() - 1;
    while (byDepth_[depth].empty()) --depth;
    const std::size_t count = std::min(byDepth_[depth].size(), most);
    byDepth_[depth].moveLast(count, into);
    size_ -= count;
  }
  void clear() {
    byDepth_.clear();
    size_ = 0;
  }

 private:
  static constexpr int kDepths = 64;  // deeper ones share the last bundle
  std::vector<RayBundle> byDepth_;
  std::uint64_t size_ = 0;
};

// Shadow rays of intersections of others, last in, first out.
class ShadowQueue {
 public:
  std::size_t bundles() const { return heads_.size(); }  // one per intersection
  void add(const ShadowTask& task) {
    heads_.push_back({task.head, static_cast<std::uint32_t>(task.rays.size())});
    rays_.insert(rays_.end(), task.rays.begin(), task.rays.end());
  }
  // The last intersections with `enough` rays together, or all; pop() removes them.
  std::span<const ShadowBundles::Visitors> last(std::size_t enough) {
    first_ = heads_.size();
    taken_ = 0;
    while (first_ > 0 && taken_ < enough) taken_ += heads_[--first_].rays;
    visitors_.clear();
    std::size_t next = rays_.size() - taken_;
    for (std::size_t i = first_; i < heads_.size(); ++i) {
      visitors_.push_back({heads_[i].head, std::span(rays_).subspan(next, heads_[i].rays)});
      next += heads_[i].rays;
    }
    return visitors_;
  }
  void pop() {
    heads_.resize(first_);
    rays_.resize(rays_.size() - taken_);
  }
  void clear() {
    heads_.clear();
    rays_.clear();
  }

 private:
  struct Head {
    ShadowHead head;
    std::uint32_t rays = 0;  // of those in rays_
  };
  std::vector<Head> heads_;
  std::vector<ShadowTravel> rays_;  // of all of them, in the same order
  std::size_t first_ = 0, taken_ = 0;
  std::vector<ShadowBundles::Visitors> visitors_;
};

}  // namespace rayshade
