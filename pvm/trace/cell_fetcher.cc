// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/cell_fetcher.h"

#include <numeric>

namespace rayshade {
namespace {

// An estimate of a ray on the wire with the answer that comes back: a shadow ray takes 90 to 110 bytes, an answer 14 to 38.
constexpr double kBytesPerForward = 130;
// How many pyramids or bundles are expected to use a cell once it is here, if it stays: neighbours go the same way.
constexpr double kExpectedUses = 64;

}  // namespace

void CellFetcher::begin() {
  onTheWay_.clear();
  queue_.clear();
  queued_.clear();
  cache_.begin(at_.policy.cacheBytes);
  // What does not fit is thrown out before it has been used as often.
  const double model = std::accumulate(at_.cellBytes.begin(), at_.cellBytes.end(), 0.0);
  expectedUses_ =
      kExpectedUses * std::min(1.0, static_cast<double>(at_.policy.cacheBytes) / std::max(model, 1.0));
}

void CellFetcher::want(CellId cell) {
  const auto key = static_cast<std::uint32_t>(cell);
  if (isHere(cell) || onTheWay_.contains(key) || queued_.contains(key)) return;
  queue_.push_back(cell);
  queued_.insert(key);
  askMore();
}

void CellFetcher::askMore() {
  while (!queue_.empty() && onTheWay_.size() < at_.policy.outstanding) {
    const CellId cell = queue_.front();
    queue_.pop_front();
    queued_.erase(static_cast<std::uint32_t>(cell));
    onTheWay_.insert(static_cast<std::uint32_t>(cell));
    context_.outbox.post(at_.ownerOf(voxelOfCell(at_.tree, cell)), CellWanted{cell});
  }
}

bool CellFetcher::arrive(CellItems&& message) {
  const auto key = static_cast<std::uint32_t>(message.cell);
  if (onTheWay_.erase(key) == 0) return false;
  cache_.insert(message.cell, std::move(message.items), at_.exposure, at_.cellBytes[key]);
  askMore();
  cache_.pin(message.cell);
  return true;
}

bool CellFetcher::fetchingPays(CellId cell, std::size_t rays) const {
  return at_.cellBytes[static_cast<std::size_t>(cell)] <=
         kBytesPerForward * expectedUses_ * static_cast<double>(rays);
}

}  // namespace rayshade
