// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/render.h"

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

class Tracer {
 public:
  Tracer(const Scene& scene, TraceCounts& counts)
      : scene_(scene), counts_(counts), occluders_(lightPointCount(scene.setting), kNone) {}

  Color trace(const Ray& ray) {
    const Progress progress = followRay(scene_.tree, scene_.model, scene_, ray, 0, counts_);
    const Setting& setting = scene_.setting;
    if (progress.state != Progress::State::hit) return missed(ray, setting);
    const SurfacePoint at = evaluateSurface(scene_.model, progress.hit, ray, setting);
    const Secondary spawned = spawnSecondary(ray, at, setting);
    Gathered gathered;
    gathered.light.resize(spawned.lit.size());
    for (std::size_t point = 0; point < spawned.lit.size(); ++point) {
      if (spawned.lit[point] != Lit::asked) continue;
      ++counts_.shadowRays;
      ShadowRay shadow = shadowRay(ray, at, spawned.samples[point]);
      shadow.occluder = occluders_[point];
      const Progress way = followShadow(scene_.tree, scene_.model, scene_, shadow, 0, setting, counts_);
      occluders_[point] = shadow.occluder;
      gathered.light[point] = way.state == Progress::State::hit ? kBlack : shadow.through;
    }
    if (spawned.transmitted) {
      ++counts_.transmittedRays;
      gathered.transmitted = trace(*spawned.transmitted);
    }
    if (spawned.reflected) {
      ++counts_.reflectedRays;
      gathered.reflected = trace(*spawned.reflected);
    }
    return combine(describe(ray, progress.hit.t, at, spawned, setting), gathered, setting, spawned.samples);
  }

 private:
  const Scene& scene_;
  TraceCounts& counts_;
  std::vector<ObjectIndex> occluders_;  // by light point: what stopped the last ray to it
};

}  // namespace

FrameResult renderFrame(const Scene& scene, const View& view, const PictureSpec& picture, std::int32_t frame,
                        std::uint64_t seed, const std::function<void(const std::vector<Color>&)>& row) {
  Sampler sampler(picture, seed, static_cast<std::uint32_t>(frame), Sampler::Guessing::no);
  FrameResult result;
  Tracer tracer(scene, result.counts);
  std::vector<Color> finished;
  SampleId sample;
  while (!sampler.finished()) {
    while (sampler.next(sample)) {
      ++result.counts.primaryRays;
      const SamplePosition position =
          samplePosition(picture, seed, static_cast<std::uint32_t>(frame), sample);
      sampler.supply(sample, tracer.trace(primaryRay(view, position, frame)));
    }
    while (sampler.takeRow(finished)) row(finished);
  }
  result.samples = sampler.counts();
  return result;
}

}  // namespace rayshade
