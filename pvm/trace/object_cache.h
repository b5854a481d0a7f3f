// Cells of others, fetched when they are needed (Reinhard & Jansen, section 5).
//
// Bounded in bytes, least recently used out first; the cell that came in last stays, even when it is larger than all the room.
// A cell that comes is a small model of its own, so that its memory goes when it goes.  What cells were worth while they were here
// is counted: it says whether fetching pays (cell_fetcher.h).
//
// Where all cells together have room, nothing needs to go: now and then those that have come are joined into one model with one
// accelerator, in which objects that lie in several cells are once.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <list>
#include <memory>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "pvm/messages/cells.h"
#include "rayshade/trace/local_space.h"

namespace rayshade {

// What a byte of objects on the wire takes here, about: spheres and triangles 2 to 3.
inline constexpr double kCacheBytesPerWireByte = 3;

class ObjectCache {
 public:
  void begin(std::size_t mostBytes);

  // The cell, for so many rays; it becomes the most recently used one.  Nothing when it is not here, or joined.
  RegionRef find(CellId cell, std::size_t rays = 1);
  bool contains(CellId cell) const {
    return cells_.contains(static_cast<std::uint32_t>(cell)) || isJoined(cell);
  }

  // The objects of a cell with all that they refer to, for another cache; nothing if it is not here, or joined.
  std::optional<std::vector<Item>> itemsOf(CellId cell) const;

  // Takes a cell in, after room was made for it.  How many bytes it takes here.
  std::size_t insert(CellId cell, std::vector<Item>&& items, const Exposure& exposure, std::size_t wireBytes);

  // Joins what has come if rays have looked into single cells so often since the last time that it costs less than that, and if
  // `allBytes`, what all cells that may come will take, have room while it is done.  False: nothing was done.  `own`: what the task
  // holds anyway; with the first cells its objects are joined, too, so that there is one accelerator over all.  Null: nothing.
  bool join(double allBytes, const Exposure& exposure, const Model* own = nullptr);
  bool isJoined(CellId cell) const { return joined_.cells.contains(static_cast<std::uint32_t>(cell)); }
  const Model& joinedModel() const { return joined_.model; }
  const Region& joinedRegion() const { return joined_.region; }
  bool anyJoined() const { return !joined_.cells.empty(); }
  // So many rays have looked into what is joined.
  void countJoined(std::size_t rays) {
    counts_.lookups += rays;
    counts_.hits += rays;
  }

  std::size_t bytes() const { return bytes_; }
  std::size_t bytesOf(CellId cell) const { return cells_.at(static_cast<std::uint32_t>(cell))->bytes; }
  std::size_t mostBytes() const { return mostBytes_; }
  // What single cells may have.
  std::size_t mostOfCells() const { return mostBytes_ - std::min(mostBytes_, joined_.bytes); }
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
  struct Joined {
    Model model;
    Region region;
    std::vector<std::uint32_t> objects;  // their numbers, sorted
    std::unordered_set<std::uint32_t> cells;
    std::size_t bytes = 0;
  };
  void makeRoomFor(std::size_t bytes);
  void moveIntoJoined(const Model& cell);

  std::unordered_map<std::uint32_t, std::unique_ptr<Cell>> cells_;
  std::list<std::uint32_t> order_;  // most recently used first
  std::size_t bytes_ = 0, mostBytes_ = 0;
  Joined joined_;
  std::uint64_t looks_ = 0;  // into single cells, since some were joined
  CacheCounts counts_;
  Use left_;
};

}  // namespace rayshade
