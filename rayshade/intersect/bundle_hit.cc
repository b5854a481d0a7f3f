// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/intersect/bundle_hit.h"

#include "rayshade/accel/bvh_bundle.h"
#include "rayshade/intersect/nearer.h"
#include "rayshade/intersect/placing.h"
#include "rayshade/intersect/ray_hit.h"

namespace rayshade {
namespace {

// The rays of a bundle, tested against one object after the other.
class Testers {
 public:
  Testers(const Model& model, std::span<Segment> segments) : model_(model), segments_(segments) {}

  // Calls use(i, t) with the first t > tMin at which each ray meets the object.
  template <class Use>
  void test(const Target& target, RaySet rays, Use&& use) {
    if (target.node != 0 || target.kind == kInstanceKind || target.kind == kCsgKind)
      return probe(target, rays, use);
    // A shape in the space of the rays: no node, no change of scale.
    [&]<class... S>(TypeList<S...>) {
      (void)((target.kind == kKindOf<S> ? (testShape<S>(target.body, rays, use), true) : false) || ...);
    }(AllShapes{});
  }

 private:
  template <class S, class Use>
  void testShape(std::uint32_t body, RaySet rays, Use&& use) {
    const S& shape = model_.store().shapes<S>()[body];
    forEachRay(rays, [&](std::size_t i) {
      use(i, firstWithin(shape, segments_[i].ray, segments_[i].tMin, segments_[i].tMax));
    });
  }

  template <class Use>
  void probe(const Target& target, RaySet rays, Use&& use) {
    if (intersectors_.empty()) {
      intersectors_.reserve(segments_.size());
      for (const Segment& segment : segments_)
        intersectors_.push_back(RayIntersector(model_, segment.ray, segment.moment));
    }
    forEachRay(rays, [&](std::size_t i) {
      use(i, intersectors_[i].intersect(target, segments_[i].tMin, segments_[i].tMax));
    });
  }

  const Model& model_;
  std::span<Segment> segments_;
  std::vector<RayIntersector> intersectors_;  // made when the first object comes that needs them
};

}  // namespace

void nearestHits(const Model& model, const Region& region, std::span<Segment> segments, std::span<Hit> hits,
                 Processor processor) {
  onProcessor(processor, [&]() RAYSHADE_INLINE {
    Testers testers(model, segments);
    const SceneStore& store = model.store();
    std::fill_n(hits.begin(), segments.size(), Hit{});
    region.bvh.nearest(segments, [&](std::uint32_t first, std::uint32_t count, RaySet asking) {
      RaySet improved = 0;
      for (const Target& target : std::span(region.objects).subspan(first, count)) {
        testers.test(target, asking, [&](std::size_t i, double t) {
          Hit& best = hits[i];
          ++best.tests;
          if (!(t <= segments[i].tMax)) return;  // most: the objects need not be looked at
          if (!nearer(t, store.object(target.object), segments[i].tMax,
                      best.found() ? &store.object(best.object) : nullptr))
            return;
          best.t = t;
          best.object = target.object;
          segments[i].tMax = t;
          improved |= RaySet{1} << i;
        });
      }
      return improved;
    });
  });
}

void occlusions(const Model& model, const Region& region, std::span<Segment> segments,
                std::span<Occlusion> met, Processor processor) {
  onProcessor(processor, [&]() RAYSHADE_INLINE {
    Testers testers(model, segments);
    std::fill_n(met.begin(), segments.size(), Occlusion{});
    RaySet filtered = 0;  // has met something transparent
    region.bvh.any(segments, [&](std::uint32_t first, std::uint32_t count, RaySet asking) {
      RaySet stopped = 0;
      for (const Target& target : std::span(region.objects).subspan(first, count)) {
        // Another transparent thing tells nothing new.
        testers.test(target, asking & ~stopped & ~(target.opaque ? 0 : filtered),
                     [&](std::size_t i, double t) {
                       ++met[i].tests;
                       if (t < segments[i].tMax &&
                           standsBefore(model, segments[i].ray.origin, segments[i].ray.direction,
                                        segments[i].moment, {t, target.object}, segments[i].tMax))
                         (target.opaque ? stopped : filtered) |= RaySet{1} << i;
                     });
      }
      forEachRay(stopped, [&](std::size_t i) { met[i].opaque = true; });
      return stopped;
    });
    forEachRay(filtered, [&](std::size_t i) { met[i].transparent = true; });
  });
}

}  // namespace rayshade
