// Tiles of primary rays in a pyramid-trace task, and the cells that they wait for (Reinhard & Jansen, section 4).
//
// A tile is one pyramid.  Its clip-list says which cells of the bin-tree it may touch, near to far, without any object.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <list>
#include <unordered_map>

#include "pvm/trace/ray_bundle.h"
#include "rayshade/scene/camera.h"
#include "rayshade/space/clip_list.h"

namespace rayshade {

struct Tile {
  RecordId firstRecord = 0;
  std::vector<Ray> rays;
  std::size_t next = 0;       // ray to be traced
  std::vector<CellId> cells;  // up to the horizon, without empty ones; kept in the cache
  std::size_t missing = 0;    // of those, not here yet
};

// The cells that rays from the lens through these positions of the picture may touch, near to far.
std::vector<CellId> cellsOf(const BinTree& tree, const View& view, const std::vector<Ray>& rays,
                            const std::vector<SamplePosition>& positions);

class WaitingTiles {
 public:
  void clear() {
    tiles_.clear();
    ready_.clear();
    byCell_.clear();
  }
  std::size_t size() const { return tiles_.size(); }
  bool anyReady() const { return !ready_.empty(); }
  // A tile all of whose cells are here.  Requires that there is one.
  Tile& front() { return *ready_.front(); }
  void popFront() {
    tiles_.erase(ready_.front());
    ready_.pop_front();
  }

  // A new tile.  isHere(cell): is it in the cache (then it is to be kept there)?  want(cell): it is needed.
  template <class IsHere, class Want>
  void add(Tile&& tile, IsHere isHere, Want want) {
    tiles_.push_back(std::move(tile));
    const auto at = std::prev(tiles_.end());
    for (CellId cell : at->cells) {
      if (isHere(cell)) continue;
      ++at->missing;
      byCell_[static_cast<std::uint32_t>(cell)].push_back(at);
      want(cell);
    }
    if (at->missing == 0) ready_.push_back(at);
  }
  // A cell is here; calls keep() once for each tile that has waited for it.
  template <class Keep>
  void arrive(CellId cell, Keep keep) {
    const auto waiting = byCell_.find(static_cast<std::uint32_t>(cell));
    if (waiting == byCell_.end()) return;
    for (const auto tile : waiting->second) {
      keep();
      if (--tile->missing == 0) ready_.push_back(tile);
    }
    byCell_.erase(waiting);
  }

 private:
  std::list<Tile> tiles_;                        // all of them
  std::deque<std::list<Tile>::iterator> ready_;  // with all cells
  std::unordered_map<std::uint32_t, std::vector<std::list<Tile>::iterator>> byCell_;
};

}  // namespace rayshade
