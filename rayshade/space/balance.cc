// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/balance.h"

#include <algorithm>
#include <array>
#include <vector>

namespace rayshade {
namespace {

// Planes that are admitted are looked at more closely one for each of so many shares of the bytes, on each axis.
constexpr std::size_t kGroups = 32;
constexpr double kAsGood = 0.02;  // of planes that are not admitted, those that differ by less count as equal

struct Plane {
  Cut cut;
  double fullest = kInfinity;  // what the fuller side has, relative to its portion
  double twice = 0;            // what is held on both sides, relative to all
  double badness() const { return fullest + twice; }
};

// What there is of objects: the larger part counts, of the bytes or of the number.
struct Amount {
  double bytes = 0, objects = 0;

  void add(const Amount& a) {
    bytes += a.bytes;
    objects += a.objects;
  }
};

struct Edge {
  double at;
  Amount amount;
  bool begins;  // an object begins here, else it ends
};

class Planes {
 public:
  // `shares`: by number of voxels below, their share of the bytes.
  Planes(const Bounds& box, std::span<const HeldBox> objects, std::span<const std::uint32_t> inside,
         const std::vector<double>& shares, double slack)
      : box_(box), objects_(objects), inside_(inside), shares_(shares), slack_(slack) {
    for (const std::uint32_t i : inside) all_.add({objects[i].bytes, objects[i].objects});
    if (!(all_.bytes > 0 && all_.bytes < kInfinity && all_.objects > 0 && all_.objects < kInfinity)) return;
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
    edges.reserve(2 * inside_.size() + 1);
    Amount begun, ended;
    for (const std::uint32_t i : inside_) {
      const HeldBox& object = objects_[i];
      const double low = object.box.low[axis], high = object.box.high[axis];
      const Amount amount{object.bytes, object.objects};
      if (low <= from) {
        begun.add(amount);
      } else if (low < to) {
        edges.push_back({low, amount, true});
      }
      if (high < to) edges.push_back({std::max(high, from), amount, false});
    }
    std::stable_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.at < b.at; });
    edges.push_back({to, {}, true});
    double last = from;
    for (const Edge& edge : edges) {
      const double middle = last + 0.5 * (edge.at - last);
      if (last < middle && middle < edge.at) consider({axis, middle, 1}, begun, ended);
      last = edge.at;
      (edge.begins ? begun : ended).add(edge.amount);
    }
  }

  // Of a plane: what has begun below it, and what has ended there.
  void consider(Cut cut, const Amount& begun, const Amount& ended) {
    const double lowBytes = begun.bytes / all_.bytes, highBytes = 1 - ended.bytes / all_.bytes;
    const double low = std::max(lowBytes, begun.objects / all_.objects);
    const double high = std::max(highBytes, 1 - ended.objects / all_.objects);
    const double share = lowBytes / (lowBytes + highBytes);
    cut.below = belowFor(share);
    const double lowShare = shares_[cut.below];
    const Plane plane{cut, std::max(low / lowShare, high / (1 - lowShare)),
                      std::max(lowBytes + highBytes, (begun.objects - ended.objects) / all_.objects + 1) - 1};
    Plane& best = best_[static_cast<std::size_t>(cut.axis)];
    if (plane.badness() < best.badness()) best = plane;
    if (!(plane.fullest <= slack_)) return;
    const auto group = static_cast<std::size_t>(std::clamp(share * kGroups, 0.0, kGroups - 1.0));
    Plane& kept = admitted_[static_cast<std::size_t>(cut.axis) * kGroups + group];
    if (kept.fullest == kInfinity || plane.twice < kept.twice) kept = plane;
  }

  // So many voxels below that their share is nearest.
  std::uint32_t belowFor(double share) const {
    const auto voxels = static_cast<std::uint32_t>(shares_.size() - 1), least = (voxels + 2) / 3;
    const auto first = shares_.begin() + least, last = shares_.begin() + (voxels - least);
    auto at = std::lower_bound(first, last, share);
    if (at != first && share - *(at - 1) < *at - share) --at;
    return static_cast<std::uint32_t>(at - shares_.begin());
  }

  const Bounds& box_;
  std::span<const HeldBox> objects_;
  std::span<const std::uint32_t> inside_;
  const std::vector<double>& shares_;
  double slack_;
  Amount all_;
  std::array<Plane, 3 * kGroups> admitted_;
  std::array<Plane, 3> best_;
};

// By number of voxels below, from none to all: their share of all portions.
std::vector<double> sharesBelow(std::span<const Portion> portions, double Portion::*of) {
  std::vector<double> sums{0};
  for (const Portion& portion : portions) sums.push_back(sums.back() + portion.*of);
  const double all = sums.back();
  for (double& sum : sums) sum /= all;
  return sums;
}

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
                               std::span<const std::uint32_t> inside, std::span<const CostBox> costs,
                               std::span<const Portion> portions, double slack) {
  const std::vector<double> bytes = sharesBelow(portions, &Portion::bytes);
  const std::vector<double> work = sharesBelow(portions, &Portion::work);
  const Planes planes(box, objects, inside, bytes, slack);
  std::optional<Cut> best;
  double least = kInfinity;
  for (const Plane& plane : planes.worthALook()) {
    const double sum = plane.twice + workOf(plane.cut, box, costs, work[plane.cut.below]);
    if (sum < least) {
      least = sum;
      best = plane.cut;
    }
  }
  return best;
}

}  // namespace rayshade
