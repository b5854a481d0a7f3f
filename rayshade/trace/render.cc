// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/render.h"

#include <array>
#include <memory>

#include "rayshade/intersect/bundle_hit.h"
#include "rayshade/optics/refraction.h"
#include "rayshade/shading/evaluate.h"

namespace rayshade {

void Scene::prepare(const Exposure& exposure, std::uint32_t voxels) {
  model.prepare(exposure);
  const auto objects = model.store().objectsOf(kWorld);
  Bounds world;
  for (ObjectIndex object : objects) {
    const Bounds bounds = model.boundsOf(object);
    if (bounds.finite()) world = join(world, bounds);
  }
  tree = buildBinTree(world, TreeLimits{voxels});
  regions_.clear();
  if (voxels == 1) {
    regions_.push_back(model.regionOf({objects.begin(), objects.end()}));
    return;
  }
  std::vector<std::vector<ObjectIndex>> members(voxelCount(tree));
  std::vector<VoxelId> touched;
  for (ObjectIndex object : objects) {
    touched.clear();
    voxelsTouching(tree, model.boundsOf(object), touched);
    for (VoxelId voxel : touched) members[static_cast<std::size_t>(voxel)].push_back(object);
  }
  for (auto& list : members) regions_.push_back(model.regionOf(std::move(list)));
}

std::size_t Scene::bytes() const {
  std::size_t total = model.bytes();
  for (const Region& region : regions_) total += region.bytes();
  return total;
}

Exposure exposureOf(const PictureSpec& picture, std::int32_t frame) {
  const double opens = picture.startTime + frame * picture.frameLength;
  return {opens, opens + std::max(picture.shutter, 0.0), frame};
}

namespace {

// Traces rays by recursion, a bundle at a time: neighbouring samples with each other, and so what comes of them.
class Tracer {
 public:
  Tracer(const Scene& scene, TraceCounts& counts)
      : scene_(scene), settings_(scene.settings), counts_(counts) {}

  // What each of at most kBundleSize rays sees.
  void trace(std::span<const Ray> rays, std::span<Color> seen) { trace(rays, seen, 0); }

 private:
  // A hit, and the colour that it has so far.  Colours are added in the order of combine(), to the same bits.
  struct Shaded {
    const Ray* ray;
    Color* seen;
    double t;
    SurfacePoint point;
    Facing facing;
    Color sum;
  };
  // A ray that goes on from a hit, and what its colour weighs there.
  struct OnwardRay {
    std::size_t from;
    Color weight;
  };
  struct OnwardBundle {
    std::vector<Ray> rays;
    std::vector<OnwardRay> goals;
    void clear() {
      rays.clear();
      goals.clear();
    }
    void add(std::optional<Ray>&& ray, std::size_t from, Color weight) {
      if (!ray) return;
      rays.push_back(std::move(*ray));
      goals.push_back({from, weight});
    }
  };
  // What is needed at one depth of the recursion; kept, so that no ray takes memory.
  struct Stage {
    std::array<Shaded, kBundleSize> room;
    OnwardBundle transmitted, reflected;
  };

  void trace(std::span<const Ray> rays, std::span<Color> seen, std::size_t depth) {
    if (depth == stages_.size()) stages_.push_back(std::make_unique<Stage>());
    Stage& stage = *stages_[depth];
    Hit hits[kBundleSize];
    follow(rays, hits);
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (hits[i].found()) {
        shade(rays[i], hits[i], seen[i], stage.room[count++]);
      } else {
        seen[i] = missed(rays[i], settings_);
      }
    }
    if (count == 0) return;
    const std::span shaded = std::span(stage.room).first(count);
    for (std::size_t l = settings_.lights.size(); l-- > 0;) light(shaded, static_cast<std::uint32_t>(l));

    stage.transmitted.clear();
    stage.reflected.clear();
    for (std::size_t i = 0; i < count; ++i) {
      OnwardRays onward = spawnOnward(*shaded[i].ray, shaded[i].point, settings_);
      stage.transmitted.add(std::move(onward.transmitted), i, onward.transmitWeight);
      stage.reflected.add(std::move(onward.reflected), i, onward.reflectWeight);
    }
    counts_.transmittedRays += stage.transmitted.rays.size();
    counts_.reflectedRays += stage.reflected.rays.size();
    goOn(shaded, stage.transmitted, depth);
    goOn(shaded, stage.reflected, depth);
    for (const Shaded& at : shaded)
      *at.seen = attenuated(at.sum, at.ray->origin, at.ray->direction, at.t, at.ray->extinct,
                            at.ray->media.empty(), settings_);
  }

  void follow(std::span<const Ray> rays, std::span<Hit> hits) {
    if (!scene_.undivided()) {
      for (std::size_t i = 0; i < rays.size(); ++i)
        hits[i] = followRay(scene_.tree, scene_.model, scene_, rays[i], 0, counts_).hit;
      return;
    }
    Segment segments[kBundleSize];
    for (std::size_t i = 0; i < rays.size(); ++i) segments[i] = Segment(rays[i]);
    counts_.visits += rays.size();
    nearestHits(scene_.model, scene_.space(), std::span(segments).first(rays.size()), hits);
    for (const Hit& hit : hits.first(rays.size())) {
      counts_.tests += hit.tests;
      counts_.hits += hit.found();
    }
  }

  void shade(const Ray& ray, const Hit& hit, Color& seen, Shaded& at) {
    at.ray = &ray;
    at.seen = &seen;
    at.t = hit.t;
    at.point = evaluateSurface(scene_.model, hit, ray, settings_);
    at.facing = {at.point.normal, at.point.geometricNormal, at.point.smooth,
                 mirrored(ray.direction, at.point.normal)};
    at.sum = at.point.surface.ambient * settings_.ambient;
  }

  // Adds a light to all hits.
  void light(std::span<Shaded> shaded, std::uint32_t number) {
    const LightSource& light = settings_.lights[number];
    std::visit(
        [&](const auto& kind) {
          for (int point = 0; point < kind.points(); ++point) {
            std::array<LightSample, kBundleSize> samples;
            std::array<LightVisibility, kBundleSize> states;
            for (std::size_t i = 0; i < shaded.size(); ++i) {
              const Ray& ray = *shaded[i].ray;
              samples[i] = kind.sample(
                  lightQuery(shaded[i].point.position, ray.key, ray.sample, number, settings_), point);
              states[i] = lit(light, samples[i], shaded[i].point, settings_);
            }
            addLightPoint(shaded, light.color, samples, states);
          }
        },
        light.kind);
  }

  void addLightPoint(std::span<Shaded> shaded, Color color, std::span<const LightSample> samples,
                     std::span<const LightVisibility> states) {
    Segment segments[kBundleSize];
    std::size_t from[kBundleSize];  // which hit asks
    std::size_t count = 0;
    for (std::size_t i = 0; i < shaded.size(); ++i) {
      if (states[i] != LightVisibility::traced) continue;
      segments[count] = {originOff(shaded[i].point, samples[i].shadowToward), samples[i].shadowToward,
                         samples[i].shadowDistance, shaded[i].ray->moment};
      from[count++] = i;
    }
    Color through[kBundleSize];
    std::fill_n(through, shaded.size(), kWhite);
    counts_.shadowRays += count;
    if (scene_.undivided()) {
      pass(shaded, samples, std::span(segments).first(count), from, through);
    } else {
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = from[k];
        ShadowRay shadow = shadowRay(*shaded[i].ray, shaded[i].point, samples[i]);
        const bool dark =
            followShadow(scene_.tree, scene_.model, scene_, shadow, 0, settings_, counts_).state ==
            Progress::State::hit;
        through[i] = dark ? kBlack : shadow.through;
      }
    }
    for (std::size_t i = 0; i < shaded.size(); ++i) {
      if (states[i] == LightVisibility::none || through[i] == kBlack) continue;
      Shaded& at = shaded[i];
      at.sum = addLight(at.sum, at.point.surface, at.facing, samples[i].toward,
                        samples[i].factor * (color * through[i]));
    }
  }

  // Takes shadow rays to their lights; `through` of the hit that asks becomes what arrives.
  void pass(std::span<const Shaded> shaded, std::span<const LightSample> samples, std::span<Segment> segments,
            std::span<const std::size_t> from, std::span<Color> through) {
    if (segments.empty()) return;
    counts_.visits += segments.size();
    Occlusion met[kBundleSize];
    occlusions(scene_.model, scene_.space(), segments, met);
    std::vector<ShadowRay> filtered;  // those that have a transparent surface before them
    std::size_t asking[kBundleSize];
    for (std::size_t k = 0; k < segments.size(); ++k) {
      const std::size_t i = from[k];
      counts_.tests += met[k].tests;
      if (met[k].opaque || (met[k].transparent && !settings_.transparentShadows)) {
        through[i] = kBlack;
      } else if (met[k].transparent) {
        asking[filtered.size()] = i;
        filtered.push_back(shadowRay(*shaded[i].ray, shaded[i].point, samples[i]));
      }
    }
    if (filtered.empty()) return;
    filter(filtered);
    for (std::size_t k = 0; k < filtered.size(); ++k) through[asking[k]] = filtered[k].through;
  }

  // Takes shadow rays through the transparent surfaces before them; `through` becomes black in darkness.
  void filter(std::span<ShadowRay> shadows) {
    ShadowRay* left[kBundleSize];
    std::size_t count = 0;
    for (ShadowRay& shadow : shadows) left[count++] = &shadow;
    while (count > 0) {
      Segment segments[kBundleSize];
      Hit hits[kBundleSize];
      for (std::size_t i = 0; i < count; ++i)
        segments[i] = Segment(left[i]->ray, left[i]->last, left[i]->distance);
      nearestHits(scene_.model, scene_.space(), std::span(segments).first(count), hits);
      std::size_t kept = 0;
      for (std::size_t i = 0; i < count; ++i) {
        counts_.tests += hits[i].tests;
        if (!hits[i].found()) continue;
        if (passSurface(scene_.model, hits[i], *left[i], settings_)) {
          left[kept++] = left[i];
        } else {
          left[i]->through = kBlack;
        }
      }
      count = kept;
    }
  }

  // Traces rays that go on from hits, and adds what they see.
  void goOn(std::span<Shaded> shaded, const OnwardBundle& onward, std::size_t depth) {
    if (onward.rays.empty()) return;
    Color seen[kBundleSize];
    trace(onward.rays, seen, depth + 1);
    for (std::size_t i = 0; i < onward.goals.size(); ++i) {
      Color& sum = shaded[onward.goals[i].from].sum;
      sum = sum + onward.goals[i].weight * seen[i];
    }
  }

  const Scene& scene_;
  const SceneSettings& settings_;
  TraceCounts& counts_;
  std::vector<std::unique_ptr<Stage>> stages_;  // by depth
};

}  // namespace

FrameResult renderFrame(const Scene& scene, const View& view, const PictureSpec& picture, std::int32_t frame,
                        std::uint64_t seed, const std::function<void(const std::vector<Color>&)>& row) {
  Sampler sampler(picture, seed, static_cast<std::uint32_t>(frame), Sampler::Guessing::no);
  FrameResult result;
  Tracer tracer(scene, result.counts);
  std::vector<Color> finished;
  SampleId samples[kBundleSize];
  Color seen[kBundleSize];
  std::vector<Ray> rays;
  while (!sampler.finished()) {
    while (const std::size_t count = sampler.next(samples)) {
      result.counts.primaryRays += count;
      primaryRays(view, picture, seed, frame, std::span(samples).first(count), rays);
      tracer.trace(rays, seen);
      for (std::size_t i = 0; i < count; ++i) sampler.supply(samples[i], seen[i]);
    }
    while (sampler.takeRow(finished)) row(finished);
  }
  result.samples = sampler.counts();
  return result;
}

}  // namespace rayshade
