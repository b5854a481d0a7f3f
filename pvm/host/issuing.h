// Samples out, colours in: what is on its way, and where the next goes (Reinhard & Jansen, figure 2).
//
// Data driven, the host makes runs of samples for the task of the first voxel in which their rays may meet anything, and decides which pixels are
// refined; demand driven, tasks ask for tiles and decide that themselves, but for the little that no tile can tell
// (rayshade/sampling).  At most `window` samples are on their way at a time.  What does not come home because of a death is issued
// again: samples are pure, so the same bits come back.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "pvm/host/in_flight.h"
#include "pvm/messages/outbox.h"
#include "pvm/schedule/options.h"
#include "rayshade/sampling/sampler.h"
#include "rayshade/space/voxel_bounds.h"

namespace rayshade {

class Issuing {
 public:
  // `configuration`: the one that all slaves have whenever issue() is called.
  Issuing(Outbox& outbox, const Configure& configuration, const HostOptions& options)
      : outbox_(outbox), configuration_(configuration), options_(options) {}

  void beginFrame();  // the one of the configuration
  void beginEpoch();  // the one of the configuration, when all that is shipped lies in its cells
  void endFrame();    // what is still on its way is of no use
  Sampler& sampler() { return *sampler_; }

  void issue();  // as much as the window allows
  void wanted(TaskId task) { wanting_.push_back(task); }
  void arrive(RecordId record, Color color);
  // False: no such tile is on its way, or these cannot be its colours.
  bool arrive(const TileDone& message);
  // An epoch has ended: nothing of it will come home any more.  How many samples will be issued again.
  std::size_t recall();

  std::size_t inFlight() const { return inFlight_.size() + pixelsInFlight_; }

 private:
  // A sample, and the tile that it belongs to.
  struct Issued {
    SampleId sample;
    std::uint32_t tile = kNoTile;  // in tiles_
  };
  static constexpr std::uint32_t kNoTile = 0xffffffffu;  // one that its tile did not ask for

  std::size_t window() const;
  void issueRuns();
  void issueTiles();
  VoxelId firstVoxel(const SampleId& sample) const;
  PrimaryRays takeSamples(std::size_t most);
  bool nextSample(Issued& issued);
  std::optional<Tile> nextTile();

  Outbox& outbox_;
  const Configure& configuration_;
  const HostOptions& options_;
  std::optional<Sampler> sampler_;
  InFlight<Issued> inFlight_;
  InFlight<Tile> tilesInFlight_;
  std::size_t pixelsInFlight_ = 0;  // of tiles
  std::deque<Issued> again_;        // were on their way when something died
  std::deque<Tile> tilesAgain_;
  std::deque<TaskId> wanting_;  // tasks that asked for a tile, once for each
  std::uint64_t runs_ = 0;      // of samples, sent to voxel tasks
  // Data driven: the tiles that are sampled.  Refinement is decided in all of them side by side.
  struct OpenTile {
    Tile tile;
    TileSampler sampler;
  };
  std::map<std::uint32_t, OpenTile> tiles_;
  VoxelBounds voxelBounds_;
  std::uint32_t tilesBegun_ = 0;
};

}  // namespace rayshade
