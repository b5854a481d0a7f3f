// Cells on their way from the tasks that hold them into the object cache (Reinhard & Jansen, section 5), and whether a cell is
// worth it.
//
// Rays that miss a cell run up a debt there: what it costs that they travel.  The cell is fetched when the debt reaches its price, so
// that fetching never costs more than as much again as travelling.  While there is room in the cache, cells cost a small part of
// their bytes, as each is expected to be used often, or nothing if objects are to travel.  When others must be thrown out for
// it, the price is the cell's bytes over what bytes of those that left were worth: cells that leave unused make all cells dear, and
// then rays travel.
//
// At most `outstanding` are asked for at a time; whoever waits for one is kept elsewhere, by cell.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <unordered_map>

#include "pvm/messages/task_context.h"
#include "pvm/trace/epoch_settings.h"
#include "pvm/trace/object_cache.h"

namespace rayshade {

class CellFetcher {
 public:
  CellFetcher(TaskContext& context, const EpochSettings& at, ObjectCache& cache)
      : context_(context), at_(at), cache_(cache) {}

  // A new epoch: nothing is on its way, the cache is empty.
  void begin();

  // Asks for a cell unless it is here, on its way, or empty.
  void want(CellId cell);
  bool isHere(CellId cell) const { return at_.isEmpty(cell) || cache_.contains(cell); }
  bool isComing(CellId cell) const { return coming_.contains(static_cast<std::uint32_t>(cell)); }
  // A cell has come; false: it was not asked for.  It is in the cache until the next one comes.
  bool arrive(CellItems&& message);

  // So many rays have come to a cell that is not here.  Is it on its way now, so that they can wait?  Else they travel.
  // `eager`: objects are to travel rather than rays.
  bool missed(CellId cell, std::size_t rays, bool eager);
  // Would the first cells of a list be asked for if so many rays came to each?  How many; `room`: bytes for all together.
  std::size_t worthAsking(std::span<const CellId> cells, std::size_t rays, bool eager, double room) const;

 private:
  double bytesOf(CellId cell) const;  // that it takes in the cache: known, or expected
  double room() const;  // in the cache, when all that is asked for is here                  [bytes]
  double price(double bytes, bool eager, double room) const;
  void askMore();

  TaskContext& context_;
  const EpochSettings& at_;
  ObjectCache& cache_;
  std::vector<std::uint32_t> known_;  // by cell: bytes in the cache; 0: it was never here
  double perWireByte_ = 0;            // bytes in the cache, of those that came
  std::vector<float> debts_;          // by cell
  struct Coming {
    double bytes = 0;  // bytesOf
    bool asked = false;
  };
  std::unordered_map<std::uint32_t, Coming> coming_;
  double comingBytes_ = 0;
  std::size_t onTheWay_ = 0;
  std::deque<CellId> queue_;  // more than may be on their way
};

}  // namespace rayshade
