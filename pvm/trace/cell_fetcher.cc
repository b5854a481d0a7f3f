// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/cell_fetcher.h"

#include <algorithm>

namespace rayshade {
namespace {

// What a ray that travels costs, with the answer that comes back, in bytes of a fetched model: it takes about 130 bytes on the wire,
// and as long to pack, queue and unpack as to cut out, take in and index 130 bytes of a model.
constexpr double kBytesPerTravel = 130;
// A ray looks into about four cells, and travels once instead.
constexpr double kBytesPerLook = kBytesPerTravel / 4;
// How often a cell is expected to be used that finds room.
constexpr double kExpectedUses = 64;
// Experience is trusted so far, both ways.
constexpr double kMostWorth = 16;

}  // namespace

void CellFetcher::begin() {
  coming_.clear();
  comingBytes_ = 0;
  onTheWay_ = 0;
  queue_.clear();
  known_.assign(at_.cellBytes.size(), 0);
  debts_.assign(at_.cellBytes.size(), 0);
  perWireByte_ = kCacheBytesPerWireByte;  // until cells have come
  cache_.begin(at_.policy.cacheBytes);
}

double CellFetcher::bytesOf(CellId cell) const {
  const auto at = static_cast<std::size_t>(cell);
  return known_[at] > 0 ? known_[at] : perWireByte_ * at_.cellBytes[at];
}

double CellFetcher::room() const {
  return static_cast<double>(cache_.mostBytes()) - static_cast<double>(cache_.bytes()) - comingBytes_;
}

double CellFetcher::price(double bytes, bool eager, double room) const {
  const auto most = static_cast<double>(cache_.mostOfCells());
  if (bytes > most) return kInfinity;
  if (bytes <= room) return eager ? 0 : bytes / kExpectedUses;
  // What is coming must not be thrown out before it is used.
  if (comingBytes_ > 0 && comingBytes_ + bytes > most / 2) return kInfinity;
  const ObjectCache::Use& left = cache_.ofThoseThatLeft();
  const double worth = left.bytes > 0 ? kBytesPerLook * left.rays / left.bytes : 1;
  return bytes / std::clamp(worth, 1 / kMostWorth, kMostWorth);
}

bool CellFetcher::missed(CellId cell, std::size_t rays, bool eager) {
  if (isComing(cell)) return true;
  float& debt = debts_[static_cast<std::size_t>(cell)];
  debt += static_cast<float>(kBytesPerTravel * static_cast<double>(rays));
  if (debt < price(bytesOf(cell), eager, room())) return false;
  want(cell);
  return true;
}

std::size_t CellFetcher::worthAsking(std::span<const CellId> cells, std::size_t rays, bool eager,
                                     double mostBytes) const {
  double left = std::min(mostBytes, room());
  std::size_t n = 0;
  for (; n < cells.size(); ++n) {
    if (isHere(cells[n]) || isComing(cells[n])) continue;
    const double bytes = bytesOf(cells[n]);
    if (bytes > left || price(bytes, eager, left) > kBytesPerTravel * static_cast<double>(rays)) break;
    left -= bytes;
  }
  return n;
}

void CellFetcher::want(CellId cell) {
  const auto key = static_cast<std::uint32_t>(cell);
  if (isHere(cell) || isComing(cell)) return;
  const double bytes = bytesOf(cell);
  coming_.emplace(key, Coming{bytes, false});
  comingBytes_ += bytes;
  debts_[key] = 0;
  queue_.push_back(cell);
  askMore();
}

void CellFetcher::askMore() {
  while (!queue_.empty() && onTheWay_ < at_.policy.outstanding) {
    const CellId cell = queue_.front();
    queue_.pop_front();
    coming_.at(static_cast<std::uint32_t>(cell)).asked = true;
    ++onTheWay_;
    context_.outbox.post(at_.ownerOf(voxelOfCell(at_.tree, cell)), CellWanted{cell});
  }
}

bool CellFetcher::arrive(CellItems&& message) {
  const auto key = static_cast<std::uint32_t>(message.cell);
  const auto found = coming_.find(key);
  if (found == coming_.end() || !found->second.asked) return false;
  comingBytes_ = std::max(0.0, comingBytes_ - found->second.bytes);
  coming_.erase(found);
  --onTheWay_;
  const std::uint64_t thrownOut = cache_.counts().evicted;
  const std::size_t bytes =
      cache_.insert(message.cell, std::move(message.items), at_.exposure, at_.cellBytes[key]);
  context_.outbox.note(EventKind::cell, kNobody, key, 0, bytes);
  if (const std::uint64_t thrown = cache_.counts().evicted - thrownOut)
    context_.outbox.note(EventKind::thrown, kNobody, 0, static_cast<std::uint32_t>(thrown), 0);
  known_[key] = static_cast<std::uint32_t>(std::min<std::size_t>(bytes, 0xffffffffu));
  perWireByte_ += (static_cast<double>(bytes) / at_.cellBytes[key] - perWireByte_) / 8;
  askMore();
  return true;
}

}  // namespace rayshade
