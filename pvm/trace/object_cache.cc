// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/object_cache.h"

namespace rayshade {

RegionRef ObjectCache::find(CellId cell, std::size_t rays) {
  counts_.lookups += rays;
  const auto found = cells_.find(static_cast<std::uint32_t>(cell));
  if (found == cells_.end()) return {};
  counts_.hits += rays;
  Cell& c = *found->second;
  order_.splice(order_.begin(), order_, c.place);
  return {&c.model, &c.region};
}

void ObjectCache::insert(CellId cell, std::vector<Item>&& items, const Exposure& exposure,
                         std::size_t wireBytes) {
  const auto key = static_cast<std::uint32_t>(cell);
  if (cells_.contains(key)) return;
  auto c = std::make_unique<Cell>();
  c->model.take(std::move(items));
  c->model.prepare(exposure);
  const auto objects = c->model.store().objectsOf(kWorld);
  c->region = c->model.regionOf({objects.begin(), objects.end()});
  c->bytes = sizeof(Cell) + c->model.bytes() + c->region.bytes();
  order_.push_front(key);
  c->place = order_.begin();
  bytes_ += c->bytes;
  ++counts_.fetched;
  counts_.fetchedBytes += wireBytes;
  cells_.emplace(key, std::move(c));
  makeRoom();
  counts_.peakBytes = std::max<std::uint64_t>(counts_.peakBytes, bytes_);
}

// The cell that came in last is about to be used: it stays.
void ObjectCache::makeRoom() {
  for (auto it = order_.end(); bytes_ > mostBytes_ && it != order_.begin();) {
    --it;
    if (it == order_.begin()) break;
    const auto found = cells_.find(*it);
    if (found->second->pins > 0) continue;
    bytes_ -= found->second->bytes;
    ++counts_.evicted;
    cells_.erase(found);
    it = order_.erase(it);
  }
}

void ObjectCache::pin(CellId cell) {
  if (const auto found = cells_.find(static_cast<std::uint32_t>(cell)); found != cells_.end())
    ++found->second->pins;
}
void ObjectCache::unpin(CellId cell) {
  if (const auto found = cells_.find(static_cast<std::uint32_t>(cell)); found != cells_.end())
    --found->second->pins;
  makeRoom();
}

}  // namespace rayshade
