// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/bounds_sample.h"

#include <algorithm>
#include <numeric>

#include "rayshade/base/random.h"

namespace rayshade {

double BoundsSample::surfaceArea(const Bounds& b) {
  const Vec3 s = b.size();
  return 2 * (s.x * s.y + s.y * s.z + s.z * s.x);
}

void BoundsSample::add(const Bounds& bounds, double size) {
  const std::uint64_t number = count_++;
  if (bounds.empty() || !bounds.finite() || !(size > 0 && size < kInfinity)) return;
  const double u = static_cast<double>((mixBits(number) >> 11) + 1) * 0x1p-53;
  const auto higher = [](const Kept& a, const Kept& b) {
    return a.priority != b.priority ? a.priority > b.priority : a.number < b.number;
  };
  const Kept candidate{size / u, number, bounds, size};
  if (kept_.size() == most_) {
    if (!higher(candidate, kept_.front())) {
      threshold_ = std::max(threshold_, candidate.priority);
      return;
    }
    std::pop_heap(kept_.begin(), kept_.end(), higher);
    threshold_ = std::max(threshold_, kept_.back().priority);
    kept_.pop_back();
  }
  kept_.push_back(candidate);
  std::push_heap(kept_.begin(), kept_.end(), higher);
}

std::vector<BoundsSample::Box> BoundsSample::boxes() const {
  std::vector<std::uint32_t> order(kept_.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::uint32_t i) { return kept_[i].number; });
  std::vector<Box> boxes;
  boxes.reserve(kept_.size());
  for (const std::uint32_t i : order) {
    const Kept& k = kept_[i];
    boxes.push_back({k.bounds, std::max(1.0, threshold_ / k.size), k.size});
  }
  return boxes;
}

}  // namespace rayshade
