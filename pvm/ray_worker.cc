// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/ray_worker.h"

#include <algorithm>
#include <numeric>

namespace rayshade {
namespace {

// An estimate of a ray on the wire with the answer that comes back: a shadow ray takes 90 to 110 bytes, an answer 14 to 38.
constexpr double kBytesPerForward = 130;
// How many pyramids or bundles are expected to use a cell once it is here, if it stays: neighbours go the same way.
constexpr double kExpectedUses = 64;

}  // namespace

void RayWorker::begin(TraceSetting setting, std::uint32_t finder) {
  at_ = std::move(setting);
  finder_ = finder;
  numbers_.assign(at_.directory.shadeTasks.size(), 0);
  occluders_.assign(lightPointCount(at_.setting), {});
  visitorOccluders_.assign(lightPointCount(at_.setting), kNone);
  parked_.clear();
  parkedCount_ = 0;
  asked_.clear();
  toAsk_.clear();
  queued_.clear();
  cache_.begin(at_.policy.cacheBytes);
  // What does not fit is thrown out before it has been used as often.
  const double model = std::accumulate(at_.cellBytes.begin(), at_.cellBytes.end(), 0.0);
  expectedUses_ =
      kExpectedUses * std::min(1.0, static_cast<double>(at_.policy.cacheBytes) / std::max(model, 1.0));
}

Ground RayWorker::cell(CellId cell) {
  if (isEmpty(cell)) return {&noModel_, &nothing_};
  ++shadowCounts_.asked;
  const Ground ground = cache_.find(cell);
  if (ground.region != nullptr) ++shadowCounts_.hits;
  return ground;
}

void RayWorker::want(CellId cell) {
  const auto key = static_cast<std::uint32_t>(cell);
  if (isHere(cell) || asked_.contains(key) || queued_.contains(key)) return;
  toAsk_.push_back(cell);
  queued_.insert(key);
  askMore();
}

void RayWorker::askMore() {
  while (!toAsk_.empty() && asked_.size() < at_.policy.outstanding) {
    const CellId cell = toAsk_.front();
    toAsk_.pop_front();
    queued_.erase(static_cast<std::uint32_t>(cell));
    asked_.insert(static_cast<std::uint32_t>(cell));
    desk_.outbox.post(at_.ownerOf(voxelOfCell(at_.tree, cell)), CellWanted{cell});
  }
}

bool RayWorker::fetchingPays(CellId missing, std::size_t rays) const {
  return at_.cellBytes[static_cast<std::size_t>(missing)] <=
         kBytesPerForward * expectedUses_ * static_cast<double>(rays);
}

void RayWorker::follow(const ShadowHead& head, std::span<const ShadowTravel> rays, const Model& model,
                       const VoxelSource& voxels) {
  onward_.begin(head);
  settled_.record = head.record;
  settled_.colors.clear();
  for (const ShadowTravel& travel : rays) {
    ShadowRay shadow = shadowOf(head, travel);
    const bool hinted = travel.slot < visitorOccluders_.size();  // else it is no light point of this scene
    if (hinted) shadow.occluder = visitorOccluders_[travel.slot];
    const Progress progress =
        followShadow(at_.tree, model, voxels, shadow, travel.step, at_.setting, counts_);
    if (hinted) visitorOccluders_[travel.slot] = shadow.occluder;
    if (progress.state == Progress::State::elsewhere) {
      onward_.add(at_.ownerOf(progress.voxel), travelOf(shadow, travel.slot, progress.step));
    } else {
      settled_.colors.push_back(
          {travel.slot, progress.state == Progress::State::hit ? kBlack : shadow.through});
    }
  }
  onward_.post(desk_.outbox);
  if (!settled_.colors.empty()) desk_.outbox.post(head.shader, settled_);
}

// The rays of the bundle have all met something that is not here: decide, for the bundle as a whole, what to do.
void RayWorker::traceBundle(Bundle&& bundle, const LightSource& light) {
  const Pending& first = bundle.rays.front();
  ShadowRay probe = first.shadow;
  std::uint32_t unit = first.unit;
  const LocalProgress missing = followLocally(at_.tree, *this, probe, unit, at_.setting, counts_);
  const bool fetch =
      at_.policy.shadows == ShadowPolicy::local ||
      (at_.policy.shadows == ShadowPolicy::automatic && fetchingPays(missing.cell, bundle.rays.size()));
  if (fetch) {
    park(std::move(bundle), missing.cell, &light);
    return;
  }
  for (Pending& pending : bundle.rays) {
    const LocalProgress at =
        followLocally(at_.tree, *this, pending.shadow, pending.unit, at_.setting, counts_);
    onward_.add(at_.ownerOf(at.voxel), travelOf(pending.shadow, pending.slot, at.step));
  }
}

void RayWorker::park(Bundle&& bundle, CellId missing, const LightSource* light) {
  // A light pyramid asks for all that it may need at once; cells of one's own voxels are no use to it.
  const AreaLight* area = light == nullptr ? nullptr : std::get_if<AreaLight>(&light->kind);
  want(missing);
  if (area != nullptr) {
    const Vec3 apex = bundle.rays.front().shadow.ray.origin;
    for (CellId cell : clipList(at_.tree, pyramidTo(apex, area->corner, area->edgeU, area->edgeV)))
      if (voxel(voxelOfCell(at_.tree, cell)).region == nullptr) want(cell);
  }
  parked_[static_cast<std::uint32_t>(missing)].push_back(std::move(bundle));
  desk_.notePeak(++parkedCount_);
}

bool RayWorker::take(CellItems&& message) {
  const auto key = static_cast<std::uint32_t>(message.cell);
  if (asked_.erase(key) == 0) return false;
  const std::size_t bytes = at_.cellBytes[key];
  cache_.insert(message.cell, std::move(message.items), at_.exposure, bytes);
  askMore();
  cache_.pin(message.cell);
  const auto waiting = parked_.find(key);
  if (waiting != parked_.end()) {
    std::vector<Bundle> bundles = std::move(waiting->second);
    parked_.erase(waiting);
    parkedCount_ -= bundles.size();
    for (Bundle& bundle : bundles) resume(std::move(bundle));
  }
  return true;
}

// Goes on with a bundle; those rays that miss something again wait for it together.
void RayWorker::resume(Bundle&& bundle) {
  std::map<std::uint32_t, Bundle> missing;  // by cell
  settled_.record = bundle.head.record;
  settled_.colors.clear();
  for (Pending& pending : bundle.rays) {
    const LocalProgress progress =
        followLocally(at_.tree, *this, pending.shadow, pending.unit, at_.setting, counts_);
    if (progress.state == LocalProgress::State::missing) {
      Bundle& rest = missing.try_emplace(static_cast<std::uint32_t>(progress.cell), Bundle{bundle.head, {}})
                         .first->second;
      rest.rays.push_back(std::move(pending));
    } else {
      settled_.colors.push_back(
          {pending.slot, progress.state == LocalProgress::State::hit ? kBlack : pending.shadow.through});
    }
  }
  if (!settled_.colors.empty()) desk_.outbox.post(bundle.head.shader, settled_);
  for (auto& [cell, rest] : missing) park(std::move(rest), CellId{cell}, nullptr);
}

}  // namespace rayshade
