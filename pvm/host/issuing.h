// Samples out, colours in: which samples are on their way, and where the next ones go (Reinhard & Jansen, figure 2).
//
// Data driven, runs of samples go to the task of the voxel in which their rays begin; demand driven, pyramid tasks ask
// for tiles.  At most `window` samples are on their way at a time.  What does not come home because of a death is issued
// again: samples are pure, so the same bits come back.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/host/in_flight.h"
#include "pvm/messages/outbox.h"
#include "pvm/schedule/options.h"
#include "rayshade/sampling/sampler.h"

namespace rayshade {

class Issuing {
 public:
  // `configuration`: the one that all slaves have whenever issue() is called.
  Issuing(Outbox& outbox, const Configure& configuration, const HostOptions& options)
      : outbox_(outbox), configuration_(configuration), options_(options) {}

  void beginFrame();  // the one of the configuration
  void endFrame();    // what is still on its way is of no use
  Sampler& sampler() { return *sampler_; }

  void issue();  // as much as the window allows
  void wanted(TaskId pyramidTask) { wanting_.push_back(pyramidTask); }
  void arrive(RecordId record, Color color);
  // An epoch has ended: nothing of it will come home any more.  How many samples will be issued again.
  std::size_t recall();

  std::size_t inFlight() const { return inFlight_.size(); }

 private:
  void issueRuns();
  void issueTiles();
  PrimaryRays takeSamples(std::size_t most);
  bool nextSample(SampleId& sample);

  Outbox& outbox_;
  const Configure& configuration_;
  const HostOptions& options_;
  std::optional<Sampler> sampler_;
  InFlight inFlight_;
  std::deque<SampleId> again_;  // were on their way when something died
  std::deque<TaskId> wanting_;  // pyramid tasks that asked for a tile
  std::uint64_t runs_ = 0;      // of samples, sent to voxel tasks
};

}  // namespace rayshade
