// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/host/issuing.h"

#include "rayshade/space/walk.h"

namespace rayshade {
namespace {

// So many samples in a row go to the same task; with several clusters, to the same one.
constexpr std::size_t kRun = 64;

// One sample that is slow must not let the others run away from it: windows from the oldest to the newest.
constexpr std::size_t kMostSpan = 64;

}  // namespace

void Issuing::beginFrame() {
  const FrameRequest& request = configuration_.request;
  sampler_.emplace(request.picture, request.seed, static_cast<std::uint32_t>(configuration_.exposure.frame));
}

void Issuing::endFrame() {
  inFlight_.takeAll();
  again_.clear();
}

std::size_t Issuing::recall() {
  wanting_.clear();
  const std::vector<SampleId> samples = inFlight_.takeAll();
  again_.insert(again_.end(), samples.begin(), samples.end());
  return samples.size();
}

void Issuing::arrive(RecordId record, Color color) {
  if (const std::optional<SampleId> sample = inFlight_.take(record)) sampler_->supply(*sample, color);
}

void Issuing::issue() {
  if (configuration_.directory.pyramidTasks.empty()) {
    issueRuns();
  } else {
    issueTiles();
  }
}

// Rays of a lens may begin in another voxel than the first of their run: then they are handed on there.
void Issuing::issueRuns() {
  const Directory& directory = configuration_.directory;
  for (;;) {
    const PrimaryRays work = takeSamples(kRun);
    if (work.samples.empty()) return;
    const Ray ray = primaryRay(configuration_.request, configuration_.exposure, work.samples.front());
    VoxelWalk walk(configuration_.tree, ray.origin, ray.direction);
    WalkStep<VoxelId> first;
    walk.next(first);
    const auto cluster = static_cast<std::uint32_t>(runs_++ % directory.clusters);
    outbox_.post(directory.ownerOf(first.where, cluster), work);
  }
}

void Issuing::issueTiles() {
  while (!wanting_.empty()) {
    const PrimaryRays work = takeSamples(options_.tileSamples);
    if (work.samples.empty()) return;
    outbox_.post(wanting_.front(), work);
    wanting_.pop_front();
  }
}

// The next samples, up to `most`, as one message.
PrimaryRays Issuing::takeSamples(std::size_t most) {
  PrimaryRays work;
  work.firstRecord = inFlight_.next();
  SampleId sample;
  while (work.samples.size() < most && nextSample(sample)) {
    inFlight_.add(sample);
    work.samples.push_back(sample);
  }
  return work;
}

bool Issuing::nextSample(SampleId& sample) {
  if (inFlight_.size() >= options_.window || inFlight_.span() >= kMostSpan * options_.window) return false;
  if (again_.empty()) return sampler_->next(sample);
  sample = again_.front();
  again_.pop_front();
  return true;
}

}  // namespace rayshade
