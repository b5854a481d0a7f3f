// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/bundle.h"

#include "rayshade/space/probe.h"

namespace rayshade {
namespace {

// The rays of a bundle, ready to be tested.
class Testers {
 public:
  Testers(const Model& model, std::span<const Segment> segments)
      : store_(model.store()), count_(segments.size()) {
    probes_.reserve(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      const Ray& ray = *segments[i].ray;
      queries_[i] = {{ray.origin, ray.direction, 1}, segments[i].tMin, segments[i].tEnd};
      probes_.push_back(Probe(model, queries_[i].ray, ray.moment));
    }
  }

  std::span<RayQuery> bundle() { return std::span(queries_).first(count_); }
  RayQuery& query(std::size_t i) { return queries_[i]; }

  // Calls use(i, t) with the first t > tMin at which each ray meets the object.
  template <class Use>
  void test(const Target& target, RaySet rays, Use&& use) {
    if (target.frame == 0 && target.kind == kKindOf<Sphere>) {
      testShape(store_.shapes<Sphere>()[target.body], rays, use);
    } else if (target.frame == 0 && target.kind == kKindOf<Triangle>) {
      testShape(store_.shapes<Triangle>()[target.body], rays, use);
    } else if (target.frame == 0 && target.kind == kKindOf<PhongTriangle>) {
      testShape(store_.shapes<PhongTriangle>()[target.body], rays, use);
    } else {
      forEachRay(rays, [&](std::size_t i) {
        use(i, probes_[i].intersect(target, queries_[i].tMin, queries_[i].tMax));
      });
    }
  }

 private:
  // A shape in the space of the rays: no frame, no change of scale.
  template <class S, class Use>
  void testShape(const S& shape, RaySet rays, Use&& use) {
    forEachRay(rays, [&](std::size_t i) { use(i, shape.intersect(queries_[i].ray, queries_[i].tMin)); });
  }

  const SceneStore& store_;
  std::size_t count_;
  RayQuery queries_[kBundleSize];
  std::vector<Probe> probes_;
};

}  // namespace

void visitTogether(const Model& model, const Region& region, std::span<const Segment> segments,
                   std::span<Hit> hits) {
  Testers testers(model, segments);
  std::fill_n(hits.begin(), segments.size(), Hit{});
  region.bvh.nearest(testers.bundle(), [&](std::uint32_t first, std::uint32_t count, RaySet asking) {
    RaySet nearer = 0;
    for (const Target& target : std::span(region.objects).subspan(first, count)) {
      testers.test(target, asking, [&](std::size_t i, double t) {
        Hit& best = hits[i];
        ++best.tests;
        // What is nearest so far stands in tMax, too.
        if (!(t < segments[i].tEnd) || t > best.t) return;
        if (t == best.t &&
            precedence(model.store().object(target.object)) >= precedence(model.store().object(best.object)))
          return;
        best.t = t;
        best.object = target.object;
        testers.query(i).tMax = t;
        nearer |= RaySet{1} << i;
      });
    }
    return nearer;
  });
}

void obstructionTogether(const Model& model, const Region& region, std::span<const Segment> segments,
                         std::span<Obstruction> met) {
  Testers testers(model, segments);
  std::fill_n(met.begin(), segments.size(), Obstruction{});
  region.bvh.any(testers.bundle(), [&](std::uint32_t first, std::uint32_t count, RaySet asking) {
    RaySet stopped = 0, filtered = 0;
    forEachRay(asking, [&](std::size_t i) { filtered |= RaySet{met[i].transparent} << i; });
    for (const Target& target : std::span(region.objects).subspan(first, count)) {
      // Another transparent thing tells nothing new.
      testers.test(target, asking & ~stopped & ~(target.opaque ? 0 : filtered), [&](std::size_t i, double t) {
        ++met[i].tests;
        if (!(t < segments[i].tEnd)) return;
        (target.opaque ? met[i].opaque : met[i].transparent) = true;
        (target.opaque ? stopped : filtered) |= RaySet{1} << i;
      });
    }
    return stopped;
  });
}

}  // namespace rayshade
