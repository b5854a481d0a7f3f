// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/object_cache.h"

namespace rayshade {
namespace {

constexpr double kRemembered = 0.95;  // what one cell that leaves keeps of those before it

}  // namespace

RegionRef ObjectCache::find(CellId cell, std::size_t rays) {
  counts_.lookups += rays;
  const auto found = cells_.find(static_cast<std::uint32_t>(cell));
  if (found == cells_.end()) return {};
  counts_.hits += rays;
  Cell& c = *found->second;
  c.rays += rays;
  order_.splice(order_.begin(), order_, c.place);
  return {&c.model, &c.region};
}

std::size_t ObjectCache::insert(CellId cell, std::vector<Item>&& items, const Exposure& exposure,
                                std::size_t wireBytes) {
  const auto key = static_cast<std::uint32_t>(cell);
  if (const auto here = cells_.find(key); here != cells_.end()) return here->second->bytes;
  auto c = std::make_unique<Cell>();
  c->model.take(std::move(items));
  c->model.prepare(exposure);
  const auto objects = c->model.store().objectsOf(kWorld);
  c->region = c->model.regionOf({objects.begin(), objects.end()});
  const std::size_t bytes = sizeof(Cell) + c->model.bytes() + c->region.bytes();
  c->bytes = bytes;
  makeRoomFor(bytes);
  order_.push_front(key);
  c->place = order_.begin();
  bytes_ += bytes;
  ++counts_.fetched;
  counts_.fetchedBytes += wireBytes;
  counts_.peakBytes = std::max<std::uint64_t>(counts_.peakBytes, bytes_);
  cells_.emplace(key, std::move(c));
  return bytes;
}

void ObjectCache::makeRoomFor(std::size_t bytes) {
  while (!order_.empty() && bytes_ + bytes > mostBytes_) {
    const auto last = cells_.find(order_.back());
    const Cell& cell = *last->second;
    left_.rays = kRemembered * left_.rays + static_cast<double>(cell.rays);
    left_.bytes = kRemembered * left_.bytes + static_cast<double>(cell.bytes);
    bytes_ -= cell.bytes;
    ++counts_.evicted;
    cells_.erase(last);
    order_.pop_back();
  }
}

}  // namespace rayshade
