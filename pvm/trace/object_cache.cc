// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/object_cache.h"

#include "rayshade/scene/extract.h"

namespace rayshade {
namespace {

constexpr double kRemembered = 0.95;  // what one cell that leaves keeps of those before it

// A look into a single cell takes 0.15 us that joining would save, and joining 18 ns a byte.
constexpr double kBytesJoinedPerLook = 8;
// While cells are joined, so many times their bytes are needed: lists grow, trees are built in pieces.
constexpr double kWhileJoining = 1.5;

}  // namespace

void ObjectCache::begin(std::size_t mostBytes) {
  cells_.clear();
  order_.clear();
  bytes_ = 0;
  mostBytes_ = mostBytes;
  left_ = {};
  joined_ = {};
  looks_ = 0;
}

RegionRef ObjectCache::find(CellId cell, std::size_t rays) {
  counts_.lookups += rays;
  const auto found = cells_.find(static_cast<std::uint32_t>(cell));
  if (found == cells_.end()) return {};
  counts_.hits += rays;
  Cell& c = *found->second;
  c.rays += rays;
  looks_ += rays;
  order_.splice(order_.begin(), order_, c.place);
  return {&c.model, &c.region};
}

std::optional<std::vector<Item>> ObjectCache::itemsOf(CellId cell) const {
  const auto found = cells_.find(static_cast<std::uint32_t>(cell));
  if (found == cells_.end()) return std::nullopt;
  const SceneStore& store = found->second->model.store();
  Extract extract(store);
  for (const ObjectIndex object : store.objectsOf(kWorld)) extract.add(object);
  return std::move(extract.items);
}

std::size_t ObjectCache::insert(CellId cell, std::vector<Item>&& items, const Exposure& exposure,
                                std::size_t wireBytes) {
  const auto key = static_cast<std::uint32_t>(cell);
  if (const auto here = cells_.find(key); here != cells_.end()) return here->second->bytes;
  if (isJoined(cell)) return 0;
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

bool ObjectCache::join(double allBytes, const Exposure& exposure, const Model* own) {
  if (cells_.empty() || kBytesJoinedPerLook * static_cast<double>(looks_) < static_cast<double>(bytes_) ||
      kWhileJoining * std::max(allBytes, static_cast<double>(bytes_)) > static_cast<double>(mostBytes_))
    return false;
  looks_ = 0;
  if (own != nullptr && !anyJoined()) moveIntoJoined(*own);
  joined_.region = {};
  for (auto it = cells_.begin(); it != cells_.end(); it = cells_.erase(it)) {
    moveIntoJoined(it->second->model);
    joined_.cells.insert(it->first);
  }
  order_.clear();
  joined_.model.prepare(exposure);
  const auto objects = joined_.model.store().objectsOf(kWorld);
  joined_.region = joined_.model.regionOf({objects.begin(), objects.end()});
  joined_.bytes = joined_.model.bytes() + joined_.region.bytes() + 4 * joined_.objects.capacity() +
                  32 * joined_.cells.size();
  bytes_ = joined_.bytes;
  counts_.peakBytes = std::max<std::uint64_t>(
      counts_.peakBytes, static_cast<std::uint64_t>(kWhileJoining * static_cast<double>(bytes_)));
  return true;
}

// Those of its objects that are new, with all that they refer to.
void ObjectCache::moveIntoJoined(const Model& cell) {
  std::vector<std::uint32_t>& known = joined_.objects;
  const auto isKnown = [&](ObjectId id) {
    return std::binary_search(known.begin(), known.end(), number(id));
  };
  Extract extract(cell.store());
  for (const ObjectIndex object : cell.store().objectsOf(kWorld))
    if (!isKnown(cell.store().object(object).id)) extract.add(object);
  // Members of definitions came with an object of another cell, perhaps.
  std::erase_if(extract.items, [&](const Item& item) {
    const auto* object = std::get_if<SceneObject>(&item);
    return object != nullptr && isKnown(object->id);
  });
  const auto before = static_cast<std::ptrdiff_t>(known.size());
  for (const Item& item : extract.items)
    if (const auto* object = std::get_if<SceneObject>(&item)) known.push_back(number(object->id));
  std::sort(known.begin() + before, known.end());
  std::inplace_merge(known.begin(), known.begin() + before, known.end());
  joined_.model.take(std::move(extract.items));
}

}  // namespace rayshade
