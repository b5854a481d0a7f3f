// Cells of others, fetched when they are needed (Reinhard & Jansen, section 5).
//
// Bounded in bytes, least recently used out first; the cell that came in last stays, even when it is larger than all the room.
// Each cell is a small model of its own, so that its memory goes when it goes.  What cells were worth while they were here is
// counted: it says whether fetching pays (cell_fetcher.h).
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
    left_ = {};
  }

  // The cell, for so many rays; it becomes the most recently used one.  Nothing when it is not here.
  RegionRef find(CellId cell, std::size_t rays = 1);
  bool contains(CellId cell) const { return cells_.contains(static_cast<std::uint32_t>(cell)); }

  // Takes a cell in, after room was made for it.  How many bytes it takes here.
  std::size_t insert(CellId cell, std::vector<Item>&& items, const Exposure& exposure, std::size_t wireBytes);

  std::size_t bytes() const { return bytes_; }
  std::size_t bytesOf(CellId cell) const { return cells_.at(static_cast<std::uint32_t>(cell))->bytes; }
  std::size_t mostBytes() const { return mostBytes_; }
  const CacheCounts& counts() const { return counts_; }

  // Of the cells that were thrown out, recent ones above all: rays that looked into them, and the bytes they took.
  struct Use {
    double rays = 0, bytes = 0;
  };
  const Use& ofThoseThatLeft() const { return left_; }

 private:
  struct Cell {
    Model model;
    Region region;
    std::size_t bytes = 0;
    std::uint64_t rays = 0;                    // that looked into it
    std::list<std::uint32_t>::iterator place;  // in order_
  };
  void makeRoomFor(std::size_t bytes);

  std::unordered_map<std::uint32_t, std::unique_ptr<Cell>> cells_;
  std::list<std::uint32_t> order_;  // most recently used first
  std::size_t bytes_ = 0, mostBytes_ = 0;
  CacheCounts counts_;
  Use left_;
};

}  // namespace rayshade
