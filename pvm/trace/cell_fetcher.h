// Cells on their way from the tasks that hold them into the object cache (Reinhard & Jansen, section 5).
//
// At most `outstanding` are asked for at a time; whoever waits for one is kept elsewhere, by cell.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <unordered_set>

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
  // A cell has come; false: it was not asked for.  It stays in the cache until release(), whatever else comes in.
  bool arrive(CellItems&& message);
  void release(CellId cell) { cache_.unpin(cell); }

  // Is fetching the cell expected to move fewer bytes than sending on so many rays that come to it?
  bool fetchingPays(CellId cell, std::size_t rays) const;

 private:
  void askMore();

  TaskContext& context_;
  const EpochSettings& at_;
  ObjectCache& cache_;
  double expectedUses_ = 0;  // of a fetched cell: the less of the model the cache can hold, the fewer
  std::unordered_set<std::uint32_t> onTheWay_;
  std::deque<CellId> queue_;                  // more than may be on their way
  std::unordered_set<std::uint32_t> queued_;  // in queue_
};

}  // namespace rayshade
