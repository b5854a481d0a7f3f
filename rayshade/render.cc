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
  for (const Region& region : regions_)
    total += region.objects.capacity() * sizeof(ObjectIndex) + region.bvh.bytes();
  return total;
}

Exposure exposureOf(const PictureSpec& picture, std::int32_t frame) {
  const double opens = picture.startTime + frame * picture.frameLength;
  return {opens, opens + std::max(picture.shutter, 0.0), frame};
}

Color traceRay(const Scene& scene, const Ray& ray, TraceCounts& counts) {
  const Progress progress = followRay(scene.tree, scene.model, scene, ray, 0, counts);
  if (progress.state != Progress::State::hit) return missed(ray, scene.setting);
  const SurfacePoint at = evaluateSurface(scene.model, progress.hit, ray, scene.setting);
  const Secondary spawned = spawnSecondary(ray, at, scene.setting);
  Gathered gathered;
  gathered.light.resize(spawned.lit.size());
  for (std::size_t point = 0; point < spawned.lit.size(); ++point) {
    if (spawned.lit[point] != Lit::asked) continue;
    ++counts.shadowRays;
    ShadowRay shadow = shadowRay(ray, at, spawned.samples[point]);
    const Progress way = followShadow(scene.tree, scene.model, scene, shadow, 0, scene.setting, counts);
    gathered.light[point] = way.state == Progress::State::hit ? kBlack : shadow.through;
  }
  if (spawned.transmitted) {
    ++counts.transmittedRays;
    gathered.transmitted = traceRay(scene, *spawned.transmitted, counts);
  }
  if (spawned.reflected) {
    ++counts.reflectedRays;
    gathered.reflected = traceRay(scene, *spawned.reflected, counts);
  }
  return combine(describe(ray, progress.hit.t, at, spawned, scene.setting), gathered, scene.setting, spawned.samples);
}

FrameResult renderFrame(const Scene& scene, const View& view, const PictureSpec& picture, std::int32_t frame,
                        std::uint64_t seed, const std::function<void(const std::vector<Color>&)>& row) {
  Sampler sampler(picture, seed, static_cast<std::uint32_t>(frame), Sampler::Guessing::no);
  FrameResult result;
  std::vector<Color> finished;
  SampleId sample;
  while (!sampler.finished()) {
    while (sampler.next(sample)) {
      ++result.counts.primaryRays;
      const SamplePosition position = samplePosition(picture, seed, static_cast<std::uint32_t>(frame), sample);
      sampler.supply(sample, traceRay(scene, primaryRay(view, position, frame), result.counts));
    }
    while (sampler.takeRow(finished)) row(finished);
  }
  result.samples = sampler.counts();
  return result;
}

}  // namespace rayshade
