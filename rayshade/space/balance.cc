// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/balance.h"

#include <algorithm>
#include <array>
#include <vector>

namespace rayshade {
namespace {

// Planes that are admitted are looked at more closely one for each of so many shares of the bytes, on each axis.
constexpr std::size_t kGroups = 16;
constexpr double kAsGood = 0.02;  // of planes that are not admitted, those that differ by less count as equal

struct Plane {
  Cut cut;
  double fullest = kInfinity;  // bytes of the fuller side, relative to its portion
  double twice = 0;            // bytes that are held on both sides, relative to all
  double badness() const { return fullest + twice; }
};

struct Edge {
  double at, bytes;
  bool begins;  // an object begins here, else it ends
};

class Planes {
 public:
  Planes(const Bounds& box, std::span<const HeldBox> objects, const Portion& low, const Portion& high,
         double slack)
      : box_(box), objects_(objects), slack_(slack) {
    for (const HeldBox& object : objects) all_ += object.bytes;
    lowShare_ = low.bytes / (low.bytes + high.bytes);
    if (!(all_ > 0 && all_ < kInfinity && lowShare_ > 0 && lowShare_ < 1)) return;
    for (int axis = 0; axis < 3; ++axis) look(axis);
  }

  // Those among which the work decides.
  std::vector<Plane> worthALook() const {
    std::vector<Plane> planes;
    for (const Plane& plane : admitted_)
      if (plane.fullest < kInfinity) planes.push_back(plane);
    if (!planes.empty()) return planes;
    double least = kInfinity;
    for (const Plane& plane : best_) least = std::min(least, plane.badness());
    for (const Plane& plane : best_)
      if (plane.fullest < kInfinity && plane.badness() <= least + kAsGood) planes.push_back(plane);
    return planes;
  }

 private:
  // All planes across an axis, between the places where objects begin and end.
  void look(int axis) {
    const double from = box_.low[axis], to = box_.high[axis];
    std::vector<Edge> edges;
    edges.reserve(2 * objects_.size() + 1);
    double begun = 0, ended = 0;
    for (const HeldBox& object : objects_) {
      const double low = object.box.low[axis], high = object.box.high[axis];
      if (low <= from) {
        begun += object.bytes;
      } else if (low < to) {
        edges.push_back({low, object.bytes, true});
      }
      if (high < to) edges.push_back({std::max(high, from), object.bytes, false});
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.at < b.at; });
    edges.push_back({to, 0, true});
    double last = from;
    for (const Edge& edge : edges) {
      const double middle = last + 0.5 * (edge.at - last);
      if (last < middle && middle < edge.at) consider({axis, middle}, begun, all_ - ended);
      last = edge.at;
      (edge.begins ? begun : ended) += edge.bytes;
    }
  }

  void consider(const Cut& cut, double lowBytes, double highBytes) {
    const Plane plane{cut,
                      std::max(lowBytes / (all_ * lowShare_), highBytes / (all_ * (1 - lowShare_))),
                      (lowBytes + highBytes - all_) / all_};
    Plane& best = best_[static_cast<std::size_t>(cut.axis)];
    if (plane.badness() < best.badness()) best = plane;
    if (!(plane.fullest <= slack_)) return;
    const double first = 1 - slack_ * (1 - lowShare_), width = slack_ - 1;
    const double at = width > 0 ? (lowBytes / all_ - first) / width * kGroups : 0;
    const auto group = static_cast<std::size_t>(std::clamp(at, 0.0, kGroups - 1.0));
    Plane& kept = admitted_[static_cast<std::size_t>(cut.axis) * kGroups + group];
    if (kept.fullest == kInfinity || plane.twice < kept.twice) kept = plane;
  }

  const Bounds& box_;
  std::span<const HeldBox> objects_;
  double slack_, all_ = 0, lowShare_ = 0.5;
  std::array<Plane, 3 * kGroups> admitted_;
  std::array<Plane, 3> best_;
};

// Work beyond the portion of the busier side and at the plane, relative to all.
double workOf(const Cut& cut, const Bounds& box, std::span<const CostBox> costs, double lowShare) {
  double all = 0, below = 0, across = 0;
  for (const CostBox& c : costs) {
    const double share = shareBelow(c.box, cut.axis, cut.split);
    all += c.cost;
    below += c.cost * share;
    if (share > 0 && share < 1) across += c.cost;
  }
  if (all > 0 && all < kInfinity)
    return std::max(below / lowShare, (all - below) / (1 - lowShare)) / all - 1 + across / all;
  // Nothing is known of the work: rays cross a side in proportion to its area.
  const Vec3 size = box.size();
  const double sides[] = {size.y * size.z, size.z * size.x, size.x * size.y};
  const double area = sides[0] + sides[1] + sides[2];
  return area > 0 && area < kInfinity ? sides[cut.axis] / area : 0;
}

}  // namespace

double shareBelow(const Bounds& box, int axis, double split) {
  if (split >= box.high[axis]) return 1;
  if (split <= box.low[axis]) return 0;
  return (split - box.low[axis]) / (box.high[axis] - box.low[axis]);
}

std::optional<Cut> balancedCut(const Bounds& box, std::span<const HeldBox> objects,
                               std::span<const CostBox> costs, const Portion& low, const Portion& high,
                               double slack) {
  const Planes planes(box, objects, low, high, slack);
  const double lowShare = low.work / (low.work + high.work);
  std::optional<Cut> best;
  double least = kInfinity;
  for (const Plane& plane : planes.worthALook()) {
    const double sum = plane.twice + workOf(plane.cut, box, costs, lowShare);
    if (sum < least) {
      least = sum;
      best = plane.cut;
    }
  }
  return best;
}

}  // namespace rayshade
