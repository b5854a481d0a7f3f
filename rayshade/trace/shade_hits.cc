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
  evaluateSurface(*hit.model, hit.hit, *hit.ray, settings, at.point);
  at.facing = {at.point.normal, at.point.geometricNormal, at.point.smooth,
               mirrored(hit.ray->direction, at.point.normal)};
  at.sum = at.point.surface.ambient * settings.ambient;
  at.pending.clear();
  if (!work.records) return;
  at.visibility.assign(points);
  at.light.assign(points);
}

// The shadow rays of all hits to one light point, which have been looked at.  On return room.through is what arrives at each hit;
// those of which that is not known have one pending shadow ray more.
void traceLightPoint(LocalSpace& space, std::span<ShadedHit> shaded, const SceneSettings& settings,
                     std::size_t row, ShadingRoom& room, TraceCounts& counts) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < shaded.size(); ++i) {
    room.through[i] = kWhite;
    if (room.visibility[i] != LightVisibility::traced) continue;
    const ShadowLine line = shadowLine(shaded[i].point, room.samples[i]);
    room.segments[count] = {line.origin, line.direction, line.distance, shaded[i].ray->moment};
    room.arriving[count] = kWhite;
    room.from[count++] = i;
  }
  if (count == 0) return;
  counts.shadowRays += count;
  traceShadows(space, std::span(room.segments).first(count), {}, settings, room.arriving, room.open, counts,
               [&](std::size_t k) {
                 const ShadedHit& at = shaded[room.from[k]];
                 return shadowRay(*at.ray, at.point, room.samples[room.from[k]]);
               });
  for (std::size_t k = 0; k < count; ++k) room.through[room.from[k]] = room.arriving[k];
  for (OpenShadow& open : room.open) {
    const std::size_t i = room.from[open.index];
    room.through[i] = kBlack;  // until it has come
    shaded[i].pending.push_back({row, std::move(open.shadow), *open.next});
  }
}

}  // namespace

void shadeHits(LocalSpace& space, std::span<const RayHit> hits, const SceneSettings& settings,
               ShadingWork work, std::span<ShadedHit> shaded, ShadingRoom& room, TraceCounts& counts) {
  shaded = shaded.first(hits.size());
  const std::size_t points = work.records ? lightPointCount(settings) : 0;
  for (std::size_t i = 0; i < hits.size(); ++i) evaluate(hits[i], settings, work, points, shaded[i]);
  forEachLightPoint(settings, [&](const LightPoint& point) {
    const LightSource& light = settings.lights[point.light];
    std::visit(
        [&](const auto& kind) {
          for (std::size_t i = 0; i < shaded.size(); ++i) {
            const Ray& ray = *shaded[i].ray;
            room.samples[i] =
                kind.sample(lightQuery(shaded[i].point.position, ray.key, ray.sample, point.light, settings),
                            point.index);
            room.visibility[i] = visibilityOf(light, room.samples[i], shaded[i].point, settings);
          }
        },
        light.kind);
    traceLightPoint(space, shaded, settings, point.row, room, counts);
    for (std::size_t i = 0; i < shaded.size(); ++i) {
      ShadedHit& at = shaded[i];
      const LightVisibility visibility = room.visibility[i];
      const Color through = room.through[i];
      if (work.records) {
        at.visibility[point.row] = visibility;
        at.light[point.row] = through;
      }
      if (!work.sums || visibility == LightVisibility::none || through == kBlack || !at.pending.empty())
        continue;
      at.sum = addLight(at.sum, at.point.surface, at.facing, room.samples[i].toward,
                        room.samples[i].factor * (light.color * through));
    }
  });
  for (ShadedHit& at : shaded) {
    spawnOnward(*at.ray, at.point, settings, at.onward);
    counts.transmittedRays += at.onward.transmitted.has_value();
    counts.reflectedRays += at.onward.reflected.has_value();
  }
}

}  // namespace rayshade
