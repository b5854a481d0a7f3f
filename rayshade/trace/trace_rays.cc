// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/trace_rays.h"

#include "rayshade/accel/bvh_bundle.h"
#include "rayshade/intersect/nearer.h"

namespace rayshade {
namespace {

constexpr double kFromTheStart[kBundleSize] = {};

// Some rays of a bundle, as a bundle of their own.
struct Part {
  Segment segments[kBundleSize];
  std::size_t from[kBundleSize];
  std::size_t size = 0;

  Part(std::span<const Segment> all, RaySet rays) {
    forEachRay(rays, [&](std::size_t i) {
      from[size] = i;
      segments[size++] = all[i];
    });
  }
  std::span<Segment> rays() { return std::span(segments).first(size); }
};

// A block that was not local when some rays came to it.
struct Absent {
  std::uint32_t block;
  RaySet rays;
};

// The rays that might meet something in these blocks.
RaySet reaching(const BlockMap& map, std::span<const Absent> absent, std::span<const Segment> segments,
                std::span<const double> begin) {
  RaySet rays = 0;
  for (const Absent& a : absent) {
    forEachRay(a.rays & ~rays, [&](std::size_t i) {
      if (mayMeet(map.box(a.block), segments[i].ray, begin[i], segments[i].tMax)) rays |= RaySet{1} << i;
    });
  }
  return rays;
}

constexpr RaySet allOf(std::size_t rays) {
  return rays == kBundleSize ? ~RaySet{0} : (RaySet{1} << rays) - 1;
}

}  // namespace

RaySet nearestLocalHits(LocalSpace& space, std::span<Segment> segments, std::span<const double> begin,
                        RayKind kind, std::span<Hit> hits, std::span<const Model*> models,
                        TraceCounts& counts, Processor processor) {
  std::span<const RegionRef> whole = space.whole(segments.size(), kind);
  if (whole.empty()) {
    std::fill_n(hits.begin(), segments.size(), Hit{});
  } else {
    nearestHits(*whole[0].model, *whole[0].region, segments, hits, processor);
    std::fill_n(models.begin(), segments.size(), whole[0].model);
    counts.visits += segments.size();
    for (const Hit& hit : hits.first(segments.size())) counts.tests += hit.tests;
    whole = whole.subspan(1);
  }
  // Another region, for some rays; which have met something nearer there.
  const auto search = [&](const RegionRef& local, RaySet asking) {
    RaySet improved = 0;
    Part part(segments, asking);
    // What was found elsewhere at the same t may have to give way.
    for (std::size_t k = 0; k < part.size; ++k)
      if (hits[part.from[k]].found())
        part.segments[k].tMax = std::nextafter(part.segments[k].tMax, kInfinity);
    Hit met[kBundleSize];
    nearestHits(*local.model, *local.region, part.rays(), met, processor);
    counts.visits += part.size;
    for (std::size_t k = 0; k < part.size; ++k) {
      const std::size_t i = part.from[k];
      counts.tests += met[k].tests;
      if (!met[k].found() || !nearer(met[k].t, local.model->store().object(met[k].object), segments[i].tMax,
                                     hits[i].found() ? &models[i]->store().object(hits[i].object) : nullptr))
        continue;
      hits[i] = met[k];
      models[i] = local.model;
      segments[i].tMax = met[k].t;
      improved |= RaySet{1} << i;
    }
    return improved;
  };
  for (const RegionRef& region : whole) search(region, allOf(segments.size()));
  const BlockMap& map = space.blocks();
  if (map.inOrder().empty()) return 0;
  std::vector<Absent> absent;
  const auto visitBlocks = [&]() RAYSHADE_INLINE {
    map.bvh().nearest(segments, [&](std::uint32_t first, std::uint32_t count, RaySet asking) {
      RaySet improved = 0;
      for (const std::uint32_t block : map.inOrder().subspan(first, count)) {
        const RegionRef local = space.region(block, static_cast<std::size_t>(std::popcount(asking)), kind);
        if (local.region == nullptr) {
          absent.push_back({block, asking});
        } else {
          improved |= search(local, asking);
        }
      }
      return improved;
    });
  };
  onProcessor(processor, visitBlocks);
  return reaching(map, absent, segments, begin);
}

LocalOcclusion localOcclusion(LocalSpace& space, std::span<Segment> segments, std::span<const double> begin,
                              TraceCounts& counts, Processor processor) {
  LocalOcclusion met;
  Occlusion occlusion[kBundleSize];
  const auto note = [&](std::size_t i, const Occlusion& of) {
    counts.tests += of.tests;
    if (of.opaque) met.opaque |= RaySet{1} << i;
    if (of.transparent) met.transparent |= RaySet{1} << i;
  };
  const auto search = [&](const RegionRef& local, RaySet asking) {
    Part part(segments, asking);
    occlusions(*local.model, *local.region, part.rays(), occlusion, processor);
    counts.visits += part.size;
    for (std::size_t k = 0; k < part.size; ++k) note(part.from[k], occlusion[k]);
  };
  std::span<const RegionRef> whole = space.whole(segments.size(), RayKind::shadow);
  if (!whole.empty()) {
    occlusions(*whole[0].model, *whole[0].region, segments, occlusion, processor);
    counts.visits += segments.size();
    for (std::size_t i = 0; i < segments.size(); ++i) note(i, occlusion[i]);
    whole = whole.subspan(1);
  }
  for (const RegionRef& region : whole)
    if (const RaySet left = allOf(segments.size()) & ~met.opaque) search(region, left);
  const BlockMap& map = space.blocks();
  std::vector<Absent> absent;
  if (!map.inOrder().empty()) {
    const auto visitBlocks = [&]() RAYSHADE_INLINE {
      map.bvh().any(segments, [&](std::uint32_t first, std::uint32_t count, RaySet asking) {
        for (const std::uint32_t block : map.inOrder().subspan(first, count)) {
          const RaySet left = asking & ~met.opaque;
          if (left == 0) break;
          const RegionRef local =
              space.region(block, static_cast<std::size_t>(std::popcount(left)), RayKind::shadow);
          if (local.region == nullptr) {
            absent.push_back({block, left});
          } else {
            search(local, left);
          }
        }
        return asking & met.opaque;
      });
    };
    onProcessor(processor, visitBlocks);
  }
  for (Absent& a : absent) a.rays &= ~met.opaque;
  met.open = (reaching(map, absent, segments, begin) | map.reachingOthers(segments, begin)) & ~met.opaque;
  return met;
}

void traceRays(LocalSpace& space, std::span<const Ray> rays, std::span<const double> begin, FoundHits& found,
               TraceCounts& counts) {
  if (begin.empty()) begin = kFromTheStart;
  const std::span segments = std::span(found.segments).first(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) segments[i] = Segment(rays[i]);
  RaySet open = nearestLocalHits(space, segments, begin, RayKind::nearest, found.hits, found.models, counts);
  open |= space.blocks().reachingOthers(segments, begin);
  found.open = 0;
  forEachRay(open, [&](std::size_t i) {
    if (const auto at = nextBlock(space, segments[i].ray, begin[i], found.hits[i].t)) {
      found.open |= RaySet{1} << i;
      found.next[i] = *at;
    }
  });
  for (std::size_t i = 0; i < rays.size(); ++i) counts.hits += found.hits[i].found() && found.resolved(i);
}

}  // namespace rayshade
