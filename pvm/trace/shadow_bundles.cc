// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/shadow_bundles.h"

#include "rayshade/space/clip_list.h"

namespace rayshade {

void ShadowBundles::sendOn(const ShadowHead& head, std::span<PendingShadow> pending) {
  batch_.begin(head);
  while (!pending.empty()) {
    const LightSource& light = lightOfRow(at_.settings, pending[0].row);
    std::size_t ofLight = 0;
    while (ofLight < pending.size() && &lightOfRow(at_.settings, pending[ofLight].row) == &light) ++ofLight;
    sendOn(pending.first(ofLight), head, light);
    pending = pending.subspan(ofLight);
  }
  batch_.post(context_.outbox);
}

// Can rays wait for the cell that they miss?  Else they travel.
bool ShadowBundles::waitsFor(CellId missing, std::size_t rays) {
  const ShadowPolicy policy = at_.policy.shadows;
  return policy != ShadowPolicy::forward && cells_.missed(missing, rays, policy == ShadowPolicy::local);
}

// Of one light: decide, for the bundle as a whole, what to do.
void ShadowBundles::sendOn(std::span<PendingShadow> pending, const ShadowHead& head,
                           const LightSource& light) {
  const CellId missing = pending[0].next.cell;
  if (waitsFor(missing, pending.size())) {
    Bundle bundle{head, {}};
    for (PendingShadow& p : pending)
      bundle.rays.push_back({std::move(p.shadow), static_cast<Slot>(p.row), p.next});
    park(std::move(bundle), missing, &light);
    return;
  }
  for (const PendingShadow& p : pending)
    batch_.add(at_.ownerOf(p.next.voxel), travelOf(p.shadow, static_cast<Slot>(p.row), p.next.step));
}

void ShadowBundles::park(Bundle&& bundle, CellId missing, const LightSource* light) {
  // A light pyramid asks for all that it may need at once, if there is room; cells of held voxels are no use to it.
  const Vec3 apex = bundle.rays.front().shadow.ray.origin;
  if (const auto extent = light == nullptr ? std::nullopt : extentOf(*light, apex)) {
    std::vector<CellId> cells =
        clipList(at_.tree, pyramidTo(apex, extent->corner, extent->edgeU, extent->edgeV));
    std::erase_if(cells, [&](CellId cell) { return space_.blocks().held(voxelOfCell(at_.tree, cell)); });
    cells.resize(cells_.worthAsking(cells, bundle.rays.size(), at_.policy.shadows == ShadowPolicy::local,
                                    static_cast<double>(at_.policy.cacheBytes)));
    for (const CellId cell : cells) cells_.want(cell);
  }
  parked_[static_cast<std::uint32_t>(missing)].push_back(std::move(bundle));
  context_.notePeak(++waiting_);
}

void ShadowBundles::resume(CellId cell) {
  const auto waiting = parked_.find(static_cast<std::uint32_t>(cell));
  if (waiting == parked_.end()) return;
  std::vector<Bundle> bundles = std::move(waiting->second);
  parked_.erase(waiting);
  waiting_ -= bundles.size();
  for (Bundle& bundle : bundles) goOn(std::move(bundle));
}

// Those rays that miss something again wait for it together, or travel.
void ShadowBundles::goOn(Bundle&& bundle) {
  std::map<std::uint32_t, Bundle> missing;  // by cell
  answers_.record = bundle.head.record;
  answers_.colors.clear();
  for (std::span<Parked> rest = bundle.rays; !rest.empty();) {
    const std::span<Parked> rays = rest.first(std::min(rest.size(), kBundleSize));
    rest = rest.subspan(rays.size());
    Segment segments[kBundleSize];
    double begin[kBundleSize];
    Color through[kBundleSize];
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const ShadowRay& shadow = rays[i].shadow;
      segments[i] = Segment(shadow.ray, shadow.last, shadow.distance);
      begin[i] = rays[i].next.tEnter;
      through[i] = shadow.through;
    }
    traceShadows(space_, std::span(segments).first(rays.size()), begin, at_.settings, through, open_, counts_,
                 [&](std::size_t i) { return rays[i].shadow; });
    RaySet going = 0;
    for (OpenShadow& open : open_) {
      going |= RaySet{1} << open.index;
      Bundle& again =
          missing.try_emplace(static_cast<std::uint32_t>(open.next->cell), Bundle{bundle.head, {}})
              .first->second;
      again.rays.push_back({std::move(open.shadow), rays[open.index].slot, *open.next});
    }
    for (std::size_t i = 0; i < rays.size(); ++i)
      if ((going >> i & 1) == 0) answers_.colors.push_back({rays[i].slot, through[i]});
  }
  if (!answers_.colors.empty()) context_.outbox.post(bundle.head.shader, answers_);
  batch_.begin(bundle.head);
  for (auto& [cell, rest] : missing) {
    if (waitsFor(CellId{cell}, rest.rays.size())) {
      park(std::move(rest), CellId{cell}, nullptr);
      continue;
    }
    for (const Parked& ray : rest.rays)
      batch_.add(at_.ownerOf(ray.next.voxel), travelOf(ray.shadow, ray.slot, ray.next.step));
  }
  batch_.post(context_.outbox);
}

void ShadowBundles::follow(std::span<const Visitors> visitors) {
  // All of them in full bundles, whoever they belong to.
  struct Visitor {
    const ShadowHead* head;
    const ShadowTravel* travel;
  };
  Visitor bundle[kBundleSize];
  std::size_t count = 0;
  arriving_.clear();
  visitorsOpen_.clear();
  const auto traceBundle = [&] {
    Segment segments[kBundleSize];
    double begin[kBundleSize];
    const std::size_t first = arriving_.size();
    for (std::size_t i = 0; i < count; ++i) {
      const ShadowTravel& travel = *bundle[i].travel;
      segments[i] = {travel.origin, travel.direction, travel.distance, bundle[i].head->moment};
      segments[i].tMin = travel.last;
      begin[i] = walkedTo(at_.tree, travel.origin, travel.direction, travel.step);
      arriving_.push_back(travel.through);
    }
    traceShadows(space_, std::span(segments).first(count), begin, at_.settings,
                 std::span(arriving_).subspan(first), open_, counts_,
                 [&](std::size_t i) { return shadowOf(*bundle[i].head, *bundle[i].travel); });
    for (OpenShadow& open : open_) {
      open.index += first;
      visitorsOpen_.push_back(std::move(open));
    }
    count = 0;
  };
  for (const Visitors& some : visitors)
    for (const ShadowTravel& travel : some.rays) {
      bundle[count++] = {&some.head, &travel};
      if (count == kBundleSize) traceBundle();
    }
  traceBundle();

  std::size_t ray = 0, open = 0;
  for (const Visitors& some : visitors) {
    batch_.begin(some.head);
    answers_.record = some.head.record;
    answers_.colors.clear();
    for (const ShadowTravel& travel : some.rays) {
      if (open < visitorsOpen_.size() && visitorsOpen_[open].index == ray) {
        const OpenShadow& goes = visitorsOpen_[open++];
        batch_.add(at_.ownerOf(goes.next->voxel), travelOf(goes.shadow, travel.slot, goes.next->step));
      } else {
        answers_.colors.push_back({travel.slot, arriving_[ray]});
      }
      ++ray;
    }
    batch_.post(context_.outbox);
    if (!answers_.colors.empty()) context_.outbox.post(some.head.shader, answers_);
  }
}

}  // namespace rayshade
