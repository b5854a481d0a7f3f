// An axis-aligned extent; either side of any axis may be infinite.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "rayshade/base/vec.h"

namespace rayshade {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Bounds {
  Vec3 low{kInfinity, kInfinity, kInfinity}, high{-kInfinity, -kInfinity, -kInfinity};  // empty

  bool empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  bool finite() const { return isFinite(low) && isFinite(high); }
  Vec3 centre() const { return low * 0.5 + high * 0.5; }
  Vec3 size() const { return high - low; }
  friend bool operator==(const Bounds&, const Bounds&) = default;
};

inline constexpr Bounds kEverywhere{{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};

inline Bounds join(const Bounds& a, const Bounds& b) {
  return {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
          {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
}
inline Bounds join(const Bounds& a, Vec3 p) { return join(a, Bounds{p, p}); }

// What lies in both; may be empty.
inline Bounds common(const Bounds& a, const Bounds& b) {
  return {{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y), std::max(a.low.z, b.low.z)},
          {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y), std::min(a.high.z, b.high.z)}};
}

// Touching counts as overlapping.
inline bool overlap(const Bounds& a, const Bounds& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

inline bool contains(const Bounds& a, Vec3 p) {
  return a.low.x <= p.x && p.x <= a.high.x && a.low.y <= p.y && p.y <= a.high.y && a.low.z <= p.z &&
         p.z <= a.high.z;
}

// Bounds enlarged by a relative margin, so that no rounding in a hit's t or position can put a hit outside of
// the region that its object was entered in.  The margin is relative to the coordinates and the size: a scene
// scaled by a power of two is padded by the same bits.
inline Bounds padded(const Bounds& b) {
  constexpr double kMargin = 1e-9;
  auto magnitude = [](double x) { return std::isfinite(x) ? std::abs(x) : 0.0; };
  double reach = 0;
  for (int axis = 0; axis < 3; ++axis)
    reach = std::max({reach, magnitude(b.low[axis]), magnitude(b.high[axis])});
  const Vec3 margin{kMargin * reach, kMargin * reach, kMargin * reach};
  return {b.low - margin, b.high + margin};
}

template <class Archive>
void serialize(Archive& archive, Bounds& b) {
  archive(b.low, b.high);
}

}  // namespace rayshade
