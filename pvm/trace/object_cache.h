// Cells of others, fetched when they are needed (Reinhard & Jansen, section 5).
//
// Bounded in bytes, least recently used out first; a cell that is in use stays, even when there is room for one cell
// only.  Each cell is a small model of its own, so that its memory goes when it goes.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <list>
#include <memory>
#include <unordered_map>

#include "pvm/messages/cells.h"
#include "rayshade/trace/local_space.h"

namespace rayshade {

class ObjectCache {
 public:
  void begin(std::size_t mostBytes) {
    cells_.clear();
    order_.clear();
    bytes_ = 0;
    mostBytes_ = mostBytes;
  }

  // The cell, for so many rays; it becomes the most recently used one.  Nothing when it is not here.
  RegionRef find(CellId cell, std::size_t rays = 1);
  bool contains(CellId cell) const { return cells_.contains(static_cast<std::uint32_t>(cell)); }

  // Takes a cell in and makes room for it.
  void insert(CellId cell, std::vector<Item>&& items, const Exposure& exposure, std::size_t wireBytes);

  // A pinned cell is in use: it is not thrown out.
  void pin(CellId cell);
  void unpin(CellId cell);

  const CacheCounts& counts() const { return counts_; }

 private:
  struct Cell {
    Model model;
    Region region;
    std::size_t bytes = 0;
    int pins = 0;
    std::list<std::uint32_t>::iterator place;  // in order_
  };
  void makeRoom();

  std::unordered_map<std::uint32_t, std::unique_ptr<Cell>> cells_;
  std::list<std::uint32_t> order_;  // most recently used first
  std::size_t bytes_ = 0, mostBytes_ = 0;
  CacheCounts counts_;
};

}  // namespace rayshade
