// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/ray_worker.h"

#include <algorithm>
#include <numeric>

namespace rayshade {
namespace {

// An estimate of a ray on the wire with the answer that comes back: a shadow ray takes 90 to 110 bytes, an answer 14 to 38.
constexpr double kBytesPerForward = 130;
// How many pyramids or bundles are expected to use a cell once it is here, if it stays: neighbours go the same way.
constexpr double kExpectedUses = 64;

// Does this part of a ray lie well inside of a box?  As the box is convex, its ends tell; it may say no too often.
bool staysInside(const Bounds& box, const Segment& segment) {
  for (int axis = 0; axis < 3; ++axis) {
    const double origin = segment.ray.origin[axis], direction = segment.ray.direction[axis];
    for (const double t : {segment.tMin, segment.tMax}) {
      const double step = direction == 0 ? 0 : t * direction, at = origin + step;
      const double error = 4 * kRounding * (std::abs(origin) + std::abs(step));
      if (std::isfinite(box.low[axis]) && !(at - error > box.low[axis])) return false;
      if (std::isfinite(box.high[axis]) && !(at + error < box.high[axis])) return false;
    }
  }
  return true;
}

}  // namespace

void RayWorker::begin(TaskId host, Configure&& message, std::uint32_t cluster, std::uint32_t finder) {
  host_ = host;
  home_.clear();
  VoxelBounds voxelBounds(message.tree, message.cellBounds);
  at_ = {std::move(message.settings),
         std::move(message.tree),
         std::move(message.directory),
         cluster,
         message.exposure,
         message.policy,
         std::move(message.cellBytes),
         std::move(voxelBounds)};
  finder_ = finder;
  numbers_.assign(at_.directory.shadeTasks.size(), 0);
  occluders_.assign(lightPointCount(at_.settings), {});
  parked_.clear();
  parkedCount_ = 0;
  asked_.clear();
  toAsk_.clear();
  queued_.clear();
  near_.clear();
  cache_.begin(at_.policy.cacheBytes);
  layPatches(message.cellBounds);
  // What does not fit is thrown out before it has been used as often.
  const double model = std::accumulate(at_.cellBytes.begin(), at_.cellBytes.end(), 0.0);
  expectedUses_ =
      kExpectedUses * std::min(1.0, static_cast<double>(at_.policy.cacheBytes) / std::max(model, 1.0));
}

// Own voxels as wholes; of others, cell by cell, what may be fetched.  A task that fetches nothing asks which rays could meet
// anything of others, and finds out by the walk of such a ray where it must go.
void RayWorker::layPatches(std::span<const Bounds> cellBounds) {
  patches_.clear();
  std::vector<Bounds> boxes, ofOthers;
  const BinTree& tree = at_.tree;
  knowsOthers_ = own_ == nullptr || fetches();
  for (std::uint32_t cell = 0; cell < cellCount(tree); ++cell) {
    const Bounds& box = cellBounds[cell];
    if (box.empty()) continue;
    const VoxelId voxel = voxelOfCell(tree, CellId{cell});
    const bool mine = own_ != nullptr && at_.ownerOf(voxel) == context_.link.self();
    if (!mine && !knowsOthers_) {
      ofOthers.push_back(box);
    } else if (mine && !patches_.empty() && patches_.back().mine && patches_.back().voxel == voxel) {
      boxes.back() = join(boxes.back(), box);  // the cells of a voxel are numbered one after the other
    } else {
      boxes.push_back(box);
      patches_.push_back({voxel, CellId{cell}, mine});
    }
  }
  patchwork_ = Patchwork(std::move(boxes));
  others_ = Patchwork(std::move(ofOthers));
  onlyVoxel_.reset();
  if (!knowsOthers_ && patches_.size() == 1) onlyVoxel_ = boundsOf(tree, patches_[0].voxel);
}

// In runs of records that follow each other, as they do in a pyramid.
void RayWorker::sendHome() {
  std::sort(home_.begin(), home_.end(),
            [](const SampleColor& a, const SampleColor& b) { return a.record < b.record; });
  SampleColors message;
  for (const SampleColor& sample : home_) {
    if (!message.colors.empty() && sample.record != message.first + message.colors.size()) {
      context_.outbox.post(host_, message);
      message.colors.clear();
    }
    if (message.colors.empty()) message.first = sample.record;
    message.colors.push_back(sample.color);
  }
  if (!message.colors.empty()) context_.outbox.post(host_, message);
  home_.clear();
}

RegionRef RayWorker::patch(std::uint32_t number, std::size_t rays) {
  const PatchPlace& place = patches_[number];
  if (place.mine) return own_->own(place.voxel);
  const RegionRef ground = cache_.find(place.cell, rays);
  if (lookingForLight_) {
    shadowCounts_.asked += rays;
    if (ground.region != nullptr) shadowCounts_.hits += rays;
  }
  return ground;
}

// Where a ray enters the voxel at a position of its walk: what lies before has been looked at.
double RayWorker::beginOf(Vec3 origin, Vec3 direction, std::uint32_t step) const {
  if (step == 0) return 0;
  const auto at = stepAt<VoxelId>(at_.tree, origin, direction, step);
  return at ? at->tEnter : kInfinity;
}

void RayWorker::visit(std::span<const RayTask> rays, std::span<Patchwork::Found> found) {
  Segment segments[kBundleSize];
  double begin[kBundleSize];
  for (std::size_t i = 0; i < rays.size(); ++i) {
    segments[i] = Segment(rays[i].ray);
    begin[i] = beginOf(rays[i].ray.origin, rays[i].ray.direction, rays[i].step);
  }
  lookingForLight_ = false;
  patchwork_.visit(*this, std::span(segments).first(rays.size()), begin, found, counts_);
  const RaySet leaving = knowsOthers_ ? 0 : mayLeave(std::span(segments).first(rays.size()), begin);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    found[i].settled = found[i].settled && (leaving >> i & 1) == 0;
    counts_.hits += found[i].settled && found[i].hit.found();
  }
}

RaySet RayWorker::mayLeave(std::span<Segment> segments, std::span<const double> begin) const {
  Segment leaving[kBundleSize];
  std::size_t from[kBundleSize], count = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    Segment& segment = segments[i];
    segment.tMin = std::max(segment.tMin, begin[i]);
    if (onlyVoxel_ && staysInside(*onlyVoxel_, segment)) continue;
    leaving[count] = segment;
    from[count++] = i;
  }
  RaySet rays = 0;
  if (count > 0)
    forEachRay(others_.touching(std::span(leaving).first(count)),
               [&](std::size_t k) { rays |= RaySet{1} << from[k]; });
  return rays;
}

std::optional<WalkStep<VoxelId>> RayWorker::elsewhere(const LocalRay& ray, double t,
                                                      std::uint32_t& step) const {
  VoxelWalk walk(at_.tree, ray.origin, ray.direction);
  WalkStep<VoxelId> at;
  for (std::uint32_t i = 0; walk.next(at) && at.tEnter <= t; ++i) {
    if (i < step || at_.ownerOf(at.where) == context_.link.self()) continue;
    if (!at_.voxelBounds.mayMeet(at.where, ray.origin, ray.direction, at.tEnter, std::min(at.tExit, t)))
      continue;
    step = i;
    return at;
  }
  return std::nullopt;
}

void RayWorker::lookAt(std::span<const FoundHit> hits) {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    Shading& shading = shadings_[i];
    shading.at = evaluateSurface(*hits[i].model, hits[i].hit, *hits[i].ray, at_.settings);
    shading.spawned = spawnSecondary(*hits[i].ray, shading.at, at_.settings);
    shading.gathered.light.assign(shading.spawned.lit.size());
    shading.pending.clear();
  }
}

// The shadow rays of all hits to one light point.
void RayWorker::askLight(std::span<const FoundHit> hits, std::size_t point) {
  Segment segments[kBundleSize];
  std::size_t from[kBundleSize], count = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (shadings_[i].spawned.lit[point] != LightVisibility::traced) continue;
    const LightSample& sample = shadings_[i].spawned.samples[point];
    segments[count] = {originOff(shadings_[i].at, sample.shadowToward), sample.shadowToward,
                       sample.shadowDistance, hits[i].ray->moment};
    from[count++] = i;
  }
  if (count == 0) return;
  counts_.shadowRays += count;
  lookingForLight_ = true;
  const double begin[kBundleSize] = {};
  Patchwork::Light light[kBundleSize];
  patchwork_.obstruct(*this, std::span(segments).first(count), begin, light, counts_);
  const RaySet leaving = knowsOthers_ ? 0 : mayLeave(std::span(segments).first(count), begin);
  filtering_.clear();
  for (std::size_t k = 0; k < count; ++k) {
    Shading& shading = shadings_[from[k]];
    const bool leaves = (leaving >> k & 1) != 0;
    if (light[k] == Patchwork::Light::dark) {
      shading.gathered.light[point] = kBlack;
    } else if (light[k] == Patchwork::Light::clear && !leaves) {
      shading.gathered.light[point] = kWhite;
    } else {
      Filtering f{from[k], shadowRay(*hits[from[k]].ray, shading.at, shading.spawned.samples[point])};
      f.limit = f.shadow.distance;
      if (light[k] == Patchwork::Light::missing) f.state = Filtering::State::alone;
      if (leaves) {
        if (const auto next = elsewhere(segments[k].ray, f.shadow.distance, f.missing.step)) {
          f.missing.state = LocalProgress::State::missing;
          f.missing.voxel = next->where;
          f.limit = std::min(f.limit, next->tEnter);
        }
        if (light[k] == Patchwork::Light::clear) f.state = Filtering::State::passed;
      }
      filtering_.push_back(std::move(f));
    }
  }
  filter();
  for (Filtering& f : filtering_) {
    Shading& shading = shadings_[f.from];
    Color& through = shading.gathered.light[point];
    std::uint32_t unit = 0;
    if (f.state == Filtering::State::alone) {
      Occluder& occluder = occluders_[point];
      f.shadow.occluder = occluder.object;
      f.shadow.occluderGround = occluder.ground;
      f.missing = followLocally(at_.tree, *this, f.shadow, unit, at_.settings, counts_);
      occluder = {f.shadow.occluder, f.shadow.occluderGround};
      if (f.missing.state == LocalProgress::State::hit) f.state = Filtering::State::dark;
    }
    if (f.state == Filtering::State::dark) {
      through = kBlack;
    } else if (f.missing.state == LocalProgress::State::missing) {
      shading.pending.push_back({std::move(f.shadow), unit, static_cast<Slot>(point), f.missing});
    } else {
      through = f.shadow.through;
    }
  }
}

// Takes shadow rays through the transparent surfaces that are here, near to far and all together.
void RayWorker::filter() {
  if (filtering_.empty()) return;
  Segment segments[kBundleSize];
  const double begin[kBundleSize] = {};
  Filtering* going[kBundleSize];
  std::size_t count = 0;
  for (Filtering& f : filtering_)
    if (f.state == Filtering::State::going) going[count++] = &f;
  while (count > 0) {
    Patchwork::Found found[kBundleSize];
    for (std::size_t i = 0; i < count; ++i)
      segments[i] = Segment(going[i]->shadow.ray, going[i]->shadow.last, going[i]->limit);
    patchwork_.visit(*this, std::span(segments).first(count), begin, found, counts_);
    std::size_t left = 0;
    for (std::size_t i = 0; i < count; ++i) {
      Filtering& f = *going[i];
      if (!found[i].settled) {
        f.state = Filtering::State::alone;  // from where it is
      } else if (!found[i].hit.found()) {
        f.state = Filtering::State::passed;
      } else if (at_.settings.transparentShadows &&
                 passSurface(*found[i].model, found[i].hit, f.shadow, at_.settings)) {
        going[left++] = &f;
      } else {
        f.state = Filtering::State::dark;
      }
    }
    count = left;
  }
}

// Shades a hit, or what can be shaded of it here, or tells a shade task of it.  Says where the colours of its secondary
// rays go, if there are any.
std::optional<ReplyTo> RayWorker::conclude(const FoundHit& found, Shading& shading) {
  const Secondary& spawned = shading.spawned;
  const Ray& ray = *found.ray;
  const bool onward = spawned.transmitted || spawned.reflected;
  if (at_.policy.shadeAtOnce && shading.pending.empty()) {
    const Color sum = addLights(ray, shading.at, spawned, shading.gathered, at_.settings);
    const ReturnPath back = returnPath(ray, found.hit.t, spawned, at_.settings);
    if (onward) return ReplyTo{context_.link.self(), near_.add(sum, back, found.to), 0};
    ++combined_;
    answer(found.to, finish(sum, back, {}, {}, at_.settings));
    return std::nullopt;
  }
  const ReplyTo to = outward(found.to);
  expect_.hit = describe(ray, found.hit.t, shading.at, spawned, at_.settings);
  expect_.to = to;
  expect_.gathered = shading.gathered;
  expect_.pending.clear();
  for (const Pending& pending : shading.pending) expect_.pending.push_back(pending.slot);
  const ReplyTo there = tellShader(onward || !shading.pending.empty());
  if (!shading.pending.empty())
    sendOn({there.task, there.record, ray.moment, ray.sample, ray.key}, shading.pending);
  return onward ? std::optional(there) : std::nullopt;
}

ReplyTo RayWorker::tellShader(bool waits) {
  if (at_.directory.shadeTasks.empty()) {  // the host's mistake
    ++context_.outbox.traffic.refused;
    return {};
  }
  const std::size_t chosen = chooseShadeTask(at_.directory, serial_++);
  const TaskId shader = at_.directory.shadeTasks[chosen];
  expect_.record = recordOf(finder_, numbers_[chosen]);
  context_.outbox.post(shader, expect_);
  if (waits) ++numbers_[chosen];
  return {shader, expect_.record, 0};
}

void RayWorker::answer(ReplyTo to, Color color) {
  while (to.task == context_.link.self()) {
    LocalHit& hit = near_[to.record];
    const std::uint64_t number = to.record;
    if (hit.there.task != kNobody) {
      to = {hit.there.task, hit.there.record, to.slot};
      near_.forgetRay(number);
      break;
    }
    (to.slot == kTransmittedSlot ? hit.transmitted : hit.reflected) = color;
    if (hit.rays > 1) {
      --hit.rays;
      return;
    }
    ++combined_;
    color = finish(hit.sum, hit.back, hit.transmitted.value_or(kBlack), hit.reflected.value_or(kBlack),
                   at_.settings);
    to = hit.to;
    near_.forgetRay(number);
  }
  if (to.task != host_) {
    context_.outbox.post(to.task, Answer{to.record, to.slot, color});
    return;
  }
  home_.push_back({to.record, color});
  if (home_.size() == kMostHome) sendHome();
}

ReplyTo RayWorker::outward(ReplyTo to) {
  if (to.task != context_.link.self()) return to;
  LocalHit& hit = near_[to.record];
  if (hit.there.task == kNobody) hit.there = handOver(hit);
  const ReplyTo there{hit.there.task, hit.there.record, to.slot};
  near_.forgetRay(to.record);
  return there;
}

// With it go those that wait for it: their colours come from outside now.
ReplyTo RayWorker::handOver(LocalHit& hit) {
  const ReplyTo to = outward(hit.to);
  expect_.hit = afterLights(hit.sum, hit.back);
  expect_.to = to;
  expect_.gathered = {};
  expect_.pending.clear();
  const ReplyTo there = tellShader(true);
  if (hit.transmitted)
    context_.outbox.post(there.task, Answer{there.record, kTransmittedSlot, *hit.transmitted});
  if (hit.reflected) context_.outbox.post(there.task, Answer{there.record, kReflectedSlot, *hit.reflected});
  return there;
}

// Shadow rays of one intersection that miss something: to the tasks that have it, or into waiting until it is here.
void RayWorker::sendOn(const ShadowHead& head, std::span<Pending> pending) {
  onward_.begin(head);
  while (!pending.empty()) {
    const LightSource& light = at_.settings.lights[lightPoint(at_.settings, pending[0].slot).light];
    std::size_t ofLight = 0;
    const auto sameLight = [&](const Pending& p) {
      return &at_.settings.lights[lightPoint(at_.settings, p.slot).light] == &light;
    };
    while (ofLight < pending.size() && sameLight(pending[ofLight])) ++ofLight;
    sendOn(head, pending.first(ofLight), light);
    pending = pending.subspan(ofLight);
  }
  onward_.post(context_.outbox);
}

RegionRef RayWorker::cell(CellId cell) {
  if (isEmpty(cell)) return {&noModel_, &nothing_};
  ++shadowCounts_.asked;
  const RegionRef ground = cache_.find(cell);
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
    context_.outbox.post(at_.ownerOf(voxelOfCell(at_.tree, cell)), CellWanted{cell});
  }
}

bool RayWorker::fetchingPays(CellId missing, std::size_t rays) const {
  return at_.cellBytes[static_cast<std::size_t>(missing)] <=
         kBytesPerForward * expectedUses_ * static_cast<double>(rays);
}

void RayWorker::follow(std::span<const Visitors> visitors, const Model& model, const VoxelSource& voxels) {
  lookingForLight_ = true;
  visitorLight_.clear();
  Segment segments[kBundleSize];
  double begin[kBundleSize];
  std::size_t count = 0;
  const auto look = [&] {
    const std::size_t known = visitorLight_.size();
    visitorLight_.resize(known + count);
    const std::span light = std::span(visitorLight_).subspan(known);
    patchwork_.obstruct(*this, std::span(segments).first(count), begin, light, counts_);
    if (!knowsOthers_)
      forEachRay(mayLeave(std::span(segments).first(count), begin), [&](std::size_t i) {
        if (light[i] == Patchwork::Light::clear) light[i] = Patchwork::Light::missing;
      });
    count = 0;
  };
  for (const Visitors& some : visitors) {
    for (const ShadowTravel& travel : some.rays) {
      segments[count] = {travel.origin, travel.direction, travel.distance, some.head.moment};
      segments[count].tMin = travel.last;
      begin[count] = beginOf(travel.origin, travel.direction, travel.step);
      if (++count == kBundleSize) look();
    }
  }
  if (count > 0) look();

  std::size_t next = 0;
  for (const Visitors& some : visitors) {
    onward_.begin(some.head);
    settled_.record = some.head.record;
    settled_.colors.clear();
    for (const ShadowTravel& travel : some.rays) {
      const Patchwork::Light light = visitorLight_[next++];
      std::uint32_t step = travel.step;
      if (light == Patchwork::Light::missing) {
        if (const auto next = elsewhere({travel.origin, travel.direction, 1}, travel.distance, step)) {
          ShadowTravel rest = travel;
          rest.step = step;
          onward_.add(at_.ownerOf(next->where), rest);
          continue;
        }
      }
      if (light != Patchwork::Light::filtered) {
        settled_.colors.push_back({travel.slot, light == Patchwork::Light::dark ? kBlack : travel.through});
        continue;
      }
      ShadowRay shadow = shadowOf(some.head, travel);
      const Progress progress =
          followShadow(at_.tree, model, voxels, shadow, travel.step, at_.settings, counts_);
      if (progress.state == Progress::State::elsewhere) {
        onward_.add(at_.ownerOf(progress.voxel), travelOf(shadow, travel.slot, progress.step));
      } else {
        settled_.colors.push_back(
            {travel.slot, progress.state == Progress::State::hit ? kBlack : shadow.through});
      }
    }
    onward_.post(context_.outbox);
    if (!settled_.colors.empty()) context_.outbox.post(some.head.shader, settled_);
  }
}

// Of one light: decide, for the bundle as a whole, what to do.
void RayWorker::sendOn(const ShadowHead& head, std::span<Pending> pending, const LightSource& light) {
  const CellId missing = pending[0].missing.cell;
  const bool fetch = at_.policy.shadows == ShadowPolicy::local ||
                     (at_.policy.shadows == ShadowPolicy::automatic && fetchingPays(missing, pending.size()));
  if (fetch) {
    park({head, {std::make_move_iterator(pending.begin()), std::make_move_iterator(pending.end())}}, missing,
         &light);
    return;
  }
  for (const Pending& p : pending)
    onward_.add(at_.ownerOf(p.missing.voxel), travelOf(p.shadow, p.slot, p.missing.step));
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
  context_.notePeak(++parkedCount_);
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
        followLocally(at_.tree, *this, pending.shadow, pending.unit, at_.settings, counts_);
    if (progress.state == LocalProgress::State::missing) {
      Bundle& rest = missing.try_emplace(static_cast<std::uint32_t>(progress.cell), Bundle{bundle.head, {}})
                         .first->second;
      rest.rays.push_back(std::move(pending));
    } else {
      settled_.colors.push_back(
          {pending.slot, progress.state == LocalProgress::State::hit ? kBlack : pending.shadow.through});
    }
  }
  if (!settled_.colors.empty()) context_.outbox.post(bundle.head.shader, settled_);
  for (auto& [cell, rest] : missing) park(std::move(rest), CellId{cell}, nullptr);
}

}  // namespace rayshade
