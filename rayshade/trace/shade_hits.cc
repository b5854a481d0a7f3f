// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/shade_hits.h"

#include "rayshade/optics/refraction.h"
#include "rayshade/shading/evaluate.h"

namespace rayshade {
namespace {

void evaluate(const RayHit& hit, const SceneSettings& settings, const ShadingWork& work, std::size_t points,
              ShadedHit& at) {
  at.ray = hit.ray;
  at.t = hit.hit.t;
  at.point = evaluateSurface(*hit.model, hit.hit, *hit.ray, settings);
  at.facing = {at.point.normal, at.point.geometricNormal, at.point.smooth,
               mirrored(hit.ray->direction, at.point.normal)};
  at.sum = at.point.surface.ambient * settings.ambient;
  at.pending.clear();
  if (!work.records) return;
  at.visibility.assign(points);
  at.light.assign(points);
}

// The shadow rays of all hits to one light point.  On return `through` is what arrives at each hit; those of which that is not
// known have one pending shadow ray more.
void traceLightPoint(LocalSpace& space, std::span<ShadedHit> shaded, std::span<const LightSample> samples,
                     std::span<const LightVisibility> visibility, const SceneSettings& settings,
                     std::size_t row, std::span<Color> through, ShadingRoom& room, TraceCounts& counts) {
  Segment segments[kBundleSize];
  Color arriving[kBundleSize];
  std::size_t from[kBundleSize], count = 0;  // which hit asks
  for (std::size_t i = 0; i < shaded.size(); ++i) {
    through[i] = kWhite;
    if (visibility[i] != LightVisibility::traced) continue;
    segments[count] = {originOff(shaded[i].point, samples[i].shadowToward), samples[i].shadowToward,
                       samples[i].shadowDistance, shaded[i].ray->moment};
    arriving[count] = kWhite;
    from[count++] = i;
  }
  counts.shadowRays += count;
  traceShadows(space, std::span(segments).first(count), {}, settings, std::span(arriving).first(count),
               room.open, counts, [&](std::size_t k) {
                 return shadowRay(*shaded[from[k]].ray, shaded[from[k]].point, samples[from[k]]);
               });
  for (std::size_t k = 0; k < count; ++k) through[from[k]] = arriving[k];
  for (OpenShadow& open : room.open)
    shaded[from[open.index]].pending.push_back({row, std::move(open.shadow), *open.next});
}

}  // namespace

void shadeHits(LocalSpace& space, std::span<const RayHit> hits, const SceneSettings& settings,
               ShadingWork work, std::span<ShadedHit> shaded, ShadingRoom& room, TraceCounts& counts) {
  shaded = shaded.first(hits.size());
  const std::size_t points = work.records ? lightPointCount(settings) : 0;
  for (std::size_t i = 0; i < hits.size(); ++i) evaluate(hits[i], settings, work, points, shaded[i]);
  forEachLightPoint(settings, [&](const LightPoint& point) {
    const LightSource& light = settings.lights[point.light];
    std::array<LightSample, kBundleSize> samples;
    std::array<LightVisibility, kBundleSize> visibility;
    std::visit(
        [&](const auto& kind) {
          for (std::size_t i = 0; i < shaded.size(); ++i) {
            const Ray& ray = *shaded[i].ray;
            samples[i] =
                kind.sample(lightQuery(shaded[i].point.position, ray.key, ray.sample, point.light, settings),
                            point.index);
            visibility[i] = visibilityOf(light, samples[i], shaded[i].point, settings);
          }
        },
        light.kind);
    Color through[kBundleSize];
    traceLightPoint(space, shaded, samples, visibility, settings, point.row, through, room, counts);
    for (std::size_t i = 0; i < shaded.size(); ++i) {
      ShadedHit& at = shaded[i];
      if (work.records) {
        at.visibility[point.row] = visibility[i];
        at.light[point.row] = through[i];
      }
      if (!work.sums || visibility[i] == LightVisibility::none || through[i] == kBlack || !at.pending.empty())
        continue;
      at.sum = addLight(at.sum, at.point.surface, at.facing, samples[i].toward,
                        samples[i].factor * (light.color * through[i]));
    }
  });
  for (ShadedHit& at : shaded) {
    at.onward = spawnOnward(*at.ray, at.point, settings);
    counts.transmittedRays += at.onward.transmitted.has_value();
    counts.reflectedRays += at.onward.reflected.has_value();
  }
}

}  // namespace rayshade
