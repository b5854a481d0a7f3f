// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/host/issuing.h"

#include <cmath>

#include "rayshade/space/walk.h"

namespace rayshade {
namespace {

// So many samples in a row go to the same task; with several clusters, to the same one.
constexpr std::size_t kRun = 64;

// One sample that is slow must not let the others run away from it: windows from the oldest to the newest.
constexpr std::size_t kMostSpan = 64;

std::size_t pixelsOf(const Tile& tile) {
  return static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
}

}  // namespace

void Issuing::beginFrame() {
  const FrameRequest& request = configuration_.request;
  const auto side = static_cast<std::int32_t>(std::sqrt(options_.tilePixels));
  sampler_.emplace(request.picture, request.seed, static_cast<std::uint32_t>(configuration_.exposure.frame),
                   std::max(side, 1));
}

void Issuing::beginEpoch() {
  if (!inTiles(configuration_)) voxelBounds_ = VoxelBounds(configuration_.tree, configuration_.cellBounds);
}

void Issuing::endFrame() {
  inFlight_.takeAll();
  tilesInFlight_.takeAll();
  pixelsInFlight_ = 0;
  again_.clear();
  tilesAgain_.clear();
  tiles_.clear();
}

std::size_t Issuing::recall() {
  wanting_.clear();
  const std::size_t samples = inFlight();
  for (const Issued& issued : inFlight_.takeAll()) again_.push_back(issued);
  for (const Tile& tile : tilesInFlight_.takeAll()) tilesAgain_.push_back(tile);
  pixelsInFlight_ = 0;
  return samples;
}

void Issuing::arrive(RecordId record, Color color) {
  const std::optional<Issued> issued = inFlight_.take(record);
  if (!issued) return;
  if (issued->tile == kNoTile) return sampler_->supply(issued->sample, color);
  const auto open = tiles_.find(issued->tile);
  TileSampler& tile = open->second;
  tile.supply(issued->sample, color);
  if (!tile.finished()) return;
  sampler_->supply(tile.tile(), tile.colors());
  tiles_.erase(open);
}

bool Issuing::arrive(const TileDone& message) {
  const std::optional<Tile> tile = tilesInFlight_.take(message.number);
  if (!tile) return false;
  pixelsInFlight_ -= pixelsOf(*tile);
  if (fit(message.colors, *tile)) {
    sampler_->supply(*tile, message.colors);
    return true;
  }
  tilesAgain_.push_back(*tile);
  return false;
}

// Enough that nobody waits for the host, and when rays travel so few that what waits stays in the caches of processors.
std::size_t Issuing::window() const {
  constexpr std::size_t kInTiles = 4096, kTravelling = 512,
                        kLeast = 4096;  // samples, for each task that traces
  if (options_.window > 0) return options_.window;
  return std::max(kLeast,
                  (inTiles(configuration_) ? kInTiles : kTravelling) * finderCount(configuration_.directory));
}

void Issuing::issue() {
  if (inTiles(configuration_)) {
    issueTiles();
  } else {
    issueRuns();
  }
}

// What the ray of a sample goes through before this voxel is empty.
VoxelId Issuing::firstVoxel(const SampleId& sample) const {
  const Ray ray = primaryRay(configuration_.request, configuration_.exposure, sample);
  VoxelWalk walk(configuration_.tree, ray.origin, ray.direction);
  WalkStep<VoxelId> step, first;
  walk.next(first);
  for (step = first; !voxelBounds_.mayMeet(step.where, ray.origin, ray.direction, 0, kInfinity);)
    if (!walk.next(step)) return first.where;
  return step.where;
}

// Neighbours meet the same voxel first, as a rule.  A ray that does not is handed on by whoever gets it.
void Issuing::issueRuns() {
  const Directory& directory = configuration_.directory;
  for (;;) {
    const PrimaryRays work = takeSamples(kRun);
    if (work.samples.empty()) return;
    const auto cluster = static_cast<std::uint32_t>(runs_++ % directory.clusters);
    outbox_.post(directory.ownerOf(firstVoxel(work.samples[work.samples.size() / 2]), cluster), work);
  }
}

// Samples that no tile has traced go first as soon as they are worth a message: rows wait for them.
void Issuing::issueTiles() {
  while (!wanting_.empty()) {
    const bool many = again_.size() + sampler_->missing() >= Sampler::kMany;
    std::optional<Tile> tile;
    if (!many) tile = nextTile();
    if (tile) {
      const TileWork work{static_cast<std::uint32_t>(tilesInFlight_.next()), *tile};
      tilesInFlight_.add(*tile);
      pixelsInFlight_ += pixelsOf(*tile);
      outbox_.note(EventKind::given, wanting_.front(), work.number, static_cast<std::uint32_t>(tile->x),
                   static_cast<std::uint64_t>(tile->y));
      outbox_.post(wanting_.front(), work);
    } else {
      const PrimaryRays work = takeSamples(Sampler::kMany);
      if (work.samples.empty()) return;
      outbox_.post(wanting_.front(), work);
    }
    wanting_.pop_front();
  }
}

std::optional<Tile> Issuing::nextTile() {
  if (inFlight() > 0 && inFlight() + options_.tilePixels > window()) return std::nullopt;
  if (tilesAgain_.empty()) return sampler_->nextTile();
  const Tile tile = tilesAgain_.front();
  tilesAgain_.pop_front();
  return tile;
}

// The next samples, up to `most`, as one message.
PrimaryRays Issuing::takeSamples(std::size_t most) {
  PrimaryRays work;
  work.firstRecord = inFlight_.next();
  Issued issued;
  while (work.samples.size() < most && nextSample(issued)) {
    inFlight_.add(issued);
    work.samples.push_back(issued.sample);
  }
  return work;
}

bool Issuing::nextSample(Issued& issued) {
  if (inFlight() >= window() || inFlight_.span() >= kMostSpan * window()) return false;
  if (!again_.empty()) {
    issued = again_.front();
    again_.pop_front();
    return true;
  }
  issued.tile = kNoTile;
  if (sampler_->nextSamples(std::span(&issued.sample, 1)) == 1) return true;
  if (inTiles(configuration_)) return false;
  for (auto& [number, open] : tiles_) {
    issued.tile = number;
    if (open.next(std::span(&issued.sample, 1)) == 1) return true;
  }
  const std::optional<Tile> tile = sampler_->nextTile();
  if (!tile) return false;
  issued.tile = tilesBegun_++;
  const auto open = tiles_.emplace(issued.tile, TileSampler(sampler_->rules(), *tile)).first;
  return open->second.next(std::span(&issued.sample, 1)) == 1;
}

}  // namespace rayshade
