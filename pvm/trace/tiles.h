// Tiles of the picture in the hands of a tracing task (Reinhard & Jansen, section 4).
//
// A tile is one pyramid.  Its clip-list says which cells of the bin-tree it may touch, near to far, without any object; those up to
// the horizon are here before it is begun.  Its samples are traced bundle by bundle; the colours of some come later, from
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
  struct OpenTile {
    Tile tile;
    TileSampler sampler;
    std::vector<CellId> cells;  // up to the horizon, without empty ones; kept in the cache
    std::size_t missing = 0;    // of those, not here yet
  };

  void clear() {
    tiles_.clear();
    byCell_.clear();
    finished_.clear();
  }
  std::size_t size() const { return tiles_.size(); }
  bool has(std::uint32_t number) const { return tiles_.contains(number); }

  // A new tile.  isHere(cell): is it in the cache (then it is to be kept there)?  want(cell): it is needed.
  template <class IsHere, class Want>
  void add(std::uint32_t number, OpenTile&& tile, IsHere isHere, Want want) {
    OpenTile& open = tiles_.emplace(number, std::move(tile)).first->second;
    for (CellId cell : open.cells) {
      if (isHere(cell)) continue;
      ++open.missing;
      byCell_[static_cast<std::uint32_t>(cell)].push_back(number);
      want(cell);
    }
  }
  // A cell is here; calls keep() once for each tile that has waited for it.
  template <class Keep>
  void arrive(CellId cell, Keep keep) {
    const auto waiting = byCell_.find(static_cast<std::uint32_t>(cell));
    if (waiting == byCell_.end()) return;
    for (const std::uint32_t number : waiting->second) {
      keep();
      --tiles_.at(number).missing;
    }
    byCell_.erase(waiting);
  }

  // Samples to be traced, of one tile, and the records of their colours; how many.  None: nothing can be done now.
  std::size_t next(std::span<SampleId> samples, std::span<RecordId> records);
  // The colour of a sample.  False: no tile waits for it.
  bool supply(RecordId record, Color color);
  // A tile that is finished, which leaves.
  struct FinishedTile {
    std::uint32_t number = 0;
    TileColors colors;
    std::vector<CellId> cells;
  };
  std::optional<FinishedTile> takeFinished();

 private:
  std::map<std::uint32_t, OpenTile> tiles_;                               // by number
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> byCell_;  // who waits for a cell
  std::deque<std::uint32_t> finished_;
};

}  // namespace rayshade
