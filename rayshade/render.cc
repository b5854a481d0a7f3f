// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/render.h"

#include "rayshade/shading/evaluate.h"
#include "rayshade/space/bundle.h"

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
      : scene_(scene), counts_(counts), lightPoints_(lightPointCount(scene.setting)) {}

  // What each of at most kBundleSize rays sees.
  void trace(std::span<const Ray> rays, std::span<Color> seen) {
    const Setting& setting = scene_.setting;
    Hit hits[kBundleSize];
    follow(rays, hits);
    std::vector<Shaded> shaded;
    shaded.reserve(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (hits[i].found()) {
        shaded.emplace_back(scene_, rays[i], hits[i], seen[i]);
      } else {
        seen[i] = missed(rays[i], setting);
      }
    }
    for (std::size_t point = 0; point < lightPoints_; ++point) light(shaded, point);
    goOn(shaded, &Secondary::transmitted, &Gathered::transmitted, counts_.transmittedRays);
    goOn(shaded, &Secondary::reflected, &Gathered::reflected, counts_.reflectedRays);
    for (const Shaded& at : shaded)
      at.seen = combine(describe(at.ray, at.t, at.point, at.spawned, setting), at.gathered, setting,
                        at.spawned.samples);
  }

 private:
  // A hit and what comes of it.
  struct Shaded {
    Shaded(const Scene& scene, const Ray& ray, const Hit& hit, Color& seen)
        : ray(ray),
          seen(seen),
          t(hit.t),
          point(evaluateSurface(scene.model, hit, ray, scene.setting)),
          spawned(spawnSecondary(ray, point, scene.setting)) {
      gathered.light.resize(spawned.lit.size());
    }
    const Ray& ray;
    Color& seen;
    double t;
    SurfacePoint point;
    Secondary spawned;
    Gathered gathered;
  };

  void follow(std::span<const Ray> rays, std::span<Hit> hits) {
    if (!scene_.undivided()) {
      for (std::size_t i = 0; i < rays.size(); ++i)
        hits[i] = followRay(scene_.tree, scene_.model, scene_, rays[i], 0, counts_).hit;
      return;
    }
    Segment segments[kBundleSize];
    for (std::size_t i = 0; i < rays.size(); ++i) segments[i] = {&rays[i]};
    counts_.visits += rays.size();
    visitTogether(scene_.model, scene_.space(), std::span(segments).first(rays.size()), hits);
    for (const Hit& hit : hits.first(rays.size())) {
      counts_.tests += hit.tests;
      counts_.hits += hit.found();
    }
  }

  // Asks one point of a light for all hits.
  void light(std::vector<Shaded>& shaded, std::size_t point) {
    std::vector<ShadowRay> shadows;
    shadows.reserve(shaded.size());
    Color* through[kBundleSize];
    for (Shaded& at : shaded) {
      if (at.spawned.lit[point] != Lit::asked) continue;
      through[shadows.size()] = &at.gathered.light[point];
      shadows.push_back(shadowRay(at.ray, at.point, at.spawned.samples[point]));
    }
    counts_.shadowRays += shadows.size();
    if (scene_.undivided()) {
      passTogether(shadows);
    } else {
      for (ShadowRay& shadow : shadows)
        if (followShadow(scene_.tree, scene_.model, scene_, shadow, 0, scene_.setting, counts_).state ==
            Progress::State::hit)
          shadow.through = kBlack;
    }
    for (std::size_t i = 0; i < shadows.size(); ++i) *through[i] = shadows[i].through;
  }

  // Takes shadow rays to their lights; `through` becomes black for those that end in darkness.
  void passTogether(std::span<ShadowRay> shadows) {
    if (shadows.empty()) return;
    counts_.visits += shadows.size();
    Segment segments[kBundleSize];
    for (std::size_t i = 0; i < shadows.size(); ++i) segments[i] = {&shadows[i].ray, 0, shadows[i].distance};
    Obstruction met[kBundleSize];
    obstructionTogether(scene_.model, scene_.space(), std::span(segments).first(shadows.size()), met);
    ShadowRay* filtered[kBundleSize];  // those that have a transparent surface before them
    std::size_t count = 0;
    for (std::size_t i = 0; i < shadows.size(); ++i) {
      counts_.tests += met[i].tests;
      if (met[i].opaque || (met[i].transparent && !scene_.setting.transparentShadows)) {
        shadows[i].through = kBlack;
      } else if (met[i].transparent) {
        filtered[count++] = &shadows[i];
      }
    }
    while (count > 0) {
      for (std::size_t i = 0; i < count; ++i)
        segments[i] = {&filtered[i]->ray, filtered[i]->last, filtered[i]->distance};
      Hit hits[kBundleSize];
      visitTogether(scene_.model, scene_.space(), std::span(segments).first(count), hits);
      std::size_t left = 0;
      for (std::size_t i = 0; i < count; ++i) {
        counts_.tests += hits[i].tests;
        if (!hits[i].found()) continue;
        if (passSurface(scene_.model, hits[i], *filtered[i], scene_.setting)) {
          filtered[left++] = filtered[i];
        } else {
          filtered[i]->through = kBlack;
        }
      }
      count = left;
    }
  }

  // Traces the rays of one kind that go on from the hits.
  void goOn(std::vector<Shaded>& shaded, std::optional<Ray> Secondary::*which, Color Gathered::*color,
            std::uint64_t& counter) {
    std::vector<Ray> rays;
    Color* asking[kBundleSize];
    for (Shaded& at : shaded) {
      if (!(at.spawned.*which)) continue;
      asking[rays.size()] = &(at.gathered.*color);
      rays.push_back(std::move(*(at.spawned.*which)));
    }
    if (rays.empty()) return;
    counter += rays.size();
    Color seen[kBundleSize];
    trace(rays, seen);
    for (std::size_t i = 0; i < rays.size(); ++i) *asking[i] = seen[i];
  }

  const Scene& scene_;
  TraceCounts& counts_;
  std::size_t lightPoints_;
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
      rays.clear();
      for (const SampleId& sample : std::span(samples).first(count))
        rays.push_back(primaryRay(
            view, samplePosition(picture, seed, static_cast<std::uint32_t>(frame), sample), frame));
      tracer.trace(rays, seen);
      for (std::size_t i = 0; i < count; ++i) sampler.supply(samples[i], seen[i]);
    }
    while (sampler.takeRow(finished)) row(finished);
  }
  result.samples = sampler.counts();
  return result;
}

}  // namespace rayshade
