// Tiles of the picture in the hands of a tracing task (Reinhard & Jansen, section 4).
//
// A tile is one pyramid.  Its clip-list says which cells of the bin-tree it may touch, near to far, without any object; those up to
// the horizon are asked for before it is begun.  Its samples are traced bundle by bundle; the colours of some come later, from
// others, and meanwhile other tiles are worked on.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <map>
#include <unordered_map>

#include "pvm/messages/rays.h"
#include "rayshade/scene/camera.h"
#include "rayshade/space/clip_list.h"

namespace rayshade {

// The cells that rays from the lens through a tile may touch, near to far.
std::vector<CellId> cellsOf(const BinTree& tree, const FrameRequest& request, const SamplingRules& rules,
                            const Tile& tile, std::int32_t frame);

class TilesInHand {
 public:
  void clear() {
    tiles_.clear();
    byCell_.clear();
    finished_.clear();
  }
  std::size_t size() const { return tiles_.size(); }
  bool has(std::uint32_t number) const { return tiles_.contains(number); }

  // A new tile, which is begun when all of these cells have come.
  void add(std::uint32_t number, TileSampler&& sampler, std::span<const CellId> awaited = {});
  // A cell is here.
  void arrive(CellId cell);

  // Samples to be traced, of one tile, and the records of their colours; how many.  None: nothing can be done now.
  std::size_t next(std::span<SampleId> samples, std::span<RecordId> records);
  // The colour of a sample.  False: no tile waits for it.
  bool supply(RecordId record, Color color);
  // A tile that is finished, which leaves.
  struct FinishedTile {
    std::uint32_t number = 0;
    TileColors colors;
  };
  std::optional<FinishedTile> takeFinished();

 private:
  struct OpenTile {
    TileSampler sampler;
    std::size_t missing = 0;  // cells that are awaited
  };

  std::map<std::uint32_t, OpenTile> tiles_;                               // by number
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> byCell_;  // who waits for a cell
  std::deque<std::uint32_t> finished_;
};

}  // namespace rayshade
