// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/patchwork.h"

#include "rayshade/accel/bvh_bundle.h"

namespace rayshade {
namespace {

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

}  // namespace

// The slack is far more than the few roundings of (plane - origin) / direction.
bool mayMeet(const Bounds& box, const LocalRay& ray, double from, double to) {
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.low[axis], high = box.high[axis];
    if (!std::isfinite(low) || !std::isfinite(high)) continue;
    const double origin = ray.origin[axis], direction = ray.direction[axis];
    const double slack = 0x1p-44 * (std::abs(origin) + std::abs(low) + std::abs(high));
    const double toLow = low - slack - origin, toHigh = high + slack - origin;
    if (direction == 0) {
      if (toLow > 0 || toHigh < 0) return false;
      continue;
    }
    const double one = toLow / direction, other = toHigh / direction;
    from = std::max(from, std::min(one, other));
    to = std::min(to, std::max(one, other));
  }
  return !(from > to);
}

// The rays that might have met something nearer in a patch that is not here.
RaySet Patchwork::unsettled(std::span<const Missing> missing, std::span<const Segment> segments,
                            std::span<const double> begin) const {
  RaySet rays = 0;
  for (const Missing& m : missing) {
    forEachRay(m.rays & ~rays, [&](std::size_t i) {
      if (mayMeet(boxes_[m.patch], segments[i].ray, begin[i], segments[i].tMax)) rays |= RaySet{1} << i;
    });
  }
  return rays;
}

void Patchwork::visit(PatchSource& source, std::span<Segment> segments, std::span<const double> begin,
                      std::span<Found> found, TraceCounts& counts, Processor processor) const {
  std::fill_n(found.begin(), segments.size(), Found{});
  if (boxes_.size() == 1) {  // no need to look for it
    if (const RegionRef ground = source.patch(0, segments.size()); ground.region != nullptr) {
      Hit hits[kBundleSize];
      nearestHits(*ground.model, *ground.region, segments, hits, processor);
      counts.visits += segments.size();
      for (std::size_t i = 0; i < segments.size(); ++i) {
        counts.tests += hits[i].tests;
        if (hits[i].found()) found[i] = {hits[i], ground.model, true};
      }
      return;
    }
  }
  std::vector<Missing> missing;
  const auto visitPatches = [&]() RAYSHADE_INLINE {
    bvh_.nearest(segments, [&](std::uint32_t first, std::uint32_t count, RaySet asking) {
      RaySet nearer = 0;
      for (const std::uint32_t patch : bvh_.order().subspan(first, count)) {
        const RegionRef ground = source.patch(patch, static_cast<std::size_t>(std::popcount(asking)));
        if (ground.region == nullptr) {
          missing.push_back({patch, asking});
          continue;
        }
        Part part(segments, asking);
        // What was found elsewhere at the same t may have to give way.
        for (std::size_t k = 0; k < part.size; ++k)
          if (found[part.from[k]].hit.found())
            part.segments[k].tMax = std::nextafter(part.segments[k].tMax, kInfinity);
        Hit hits[kBundleSize];
        nearestHits(*ground.model, *ground.region, part.rays(), hits, processor);
        counts.visits += part.size;
        for (std::size_t k = 0; k < part.size; ++k) {
          const std::size_t i = part.from[k];
          counts.tests += hits[k].tests;
          Found& best = found[i];
          if (!hits[k].found()) continue;
          if (hits[k].t == best.hit.t && precedence(ground.model->store().object(hits[k].object)) >=
                                             precedence(best.model->store().object(best.hit.object)))
            continue;
          best.hit = hits[k];
          best.model = ground.model;
          segments[i].tMax = hits[k].t;
          nearer |= RaySet{1} << i;
        }
      }
      return nearer;
    });
  };
  onProcessor(processor, visitPatches);
  forEachRay(unsettled(missing, segments, begin), [&](std::size_t i) { found[i].settled = false; });
}

RaySet Patchwork::touching(std::span<Segment> segments, Processor processor) const {
  RaySet meeting = 0;
  onProcessor(processor, [&]() RAYSHADE_INLINE {
    bvh_.any(segments, [&](std::uint32_t, std::uint32_t, RaySet rays) {
      meeting |= rays;
      return rays;
    });
  });
  return meeting;
}

void Patchwork::obstruct(PatchSource& source, std::span<Segment> segments, std::span<const double> begin,
                         std::span<Light> light, TraceCounts& counts, Processor processor) const {
  if (boxes_.size() == 1) {
    if (const RegionRef ground = source.patch(0, segments.size()); ground.region != nullptr) {
      Occlusion met[kBundleSize];
      occlusions(*ground.model, *ground.region, segments, met, processor);
      counts.visits += segments.size();
      for (std::size_t i = 0; i < segments.size(); ++i) {
        counts.tests += met[i].tests;
        light[i] = met[i].opaque ? Light::dark : met[i].transparent ? Light::filtered : Light::clear;
      }
      return;
    }
  }
  std::vector<Missing> missing;
  RaySet dark = 0, filtered = 0;
  const auto visitPatches = [&]() RAYSHADE_INLINE {
    bvh_.any(segments, [&](std::uint32_t first, std::uint32_t count, RaySet asking) {
      for (const std::uint32_t patch : bvh_.order().subspan(first, count)) {
        const RaySet left = asking & ~dark;
        if (left == 0) break;
        const RegionRef ground = source.patch(patch, static_cast<std::size_t>(std::popcount(left)));
        if (ground.region == nullptr) {
          missing.push_back({patch, left});
          continue;
        }
        Part part(segments, left);
        Occlusion met[kBundleSize];
        occlusions(*ground.model, *ground.region, part.rays(), met, processor);
        counts.visits += part.size;
        for (std::size_t k = 0; k < part.size; ++k) {
          counts.tests += met[k].tests;
          if (met[k].opaque) dark |= RaySet{1} << part.from[k];
          if (met[k].transparent) filtered |= RaySet{1} << part.from[k];
        }
      }
      return asking & dark;
    });
  };
  onProcessor(processor, visitPatches);
  for (Missing& m : missing) m.rays &= ~(dark | filtered);
  const RaySet uncertain = unsettled(missing, segments, begin);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const auto among = [i](RaySet rays) { return (rays >> i & 1) != 0; };
    light[i] = among(dark)        ? Light::dark
               : among(filtered)  ? Light::filtered
               : among(uncertain) ? Light::missing
                                  : Light::clear;
  }
}

}  // namespace rayshade
