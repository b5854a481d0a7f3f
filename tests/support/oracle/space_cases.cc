// Boxes of the accelerator, borders of voxels, cells of pyramids.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/accel/bvh.h"
#include "rayshade/space/clip_list.h"
#include "rayshade/space/walk.h"
#include "tests/support/oracle/aims.h"
#include "tests/support/oracle/verdict.h"

namespace rayshade {
namespace {

using exact::Exact;
using exact::Line;
using exact::Point;

// Does the line touch the box at some t >= 0?  Products instead of quotients: with 256 bits this is exact.
bool touchesExactly(const Bounds& b, const LocalRay& ray) {
  struct Share {
    Exact over, under;  // over / under, under > 0
  };
  std::vector<Share> enters{{Exact(0), Exact(1)}}, leaves;
  for (int axis = 0; axis < 3; ++axis) {
    const Exact d(ray.direction[axis]), low = Exact(b.low[axis]) - Exact(ray.origin[axis]),
                                        high = Exact(b.high[axis]) - Exact(ray.origin[axis]);
    if (d == 0) {
      if (low > 0 || high < 0) return false;
    } else if (d > 0) {
      enters.push_back({low, d});
      leaves.push_back({high, d});
    } else {
      enters.push_back({Exact(-high), Exact(-d)});
      leaves.push_back({Exact(-low), Exact(-d)});
    }
  }
  for (const Share& in : enters)
    for (const Share& out : leaves)
      if (in.over * out.under > out.over * in.under) return false;
  return true;
}

// A tree of random cuts; the code of its nodes, in pre-order.
BinTree randomTree(HardRandom& random, const Bounds& world, int cuts) {
  TreeCode code;
  const auto grow = [&](auto&& self, Bounds box, int left) -> void {
    const int axis = random.below(3);
    const double split = box.low[axis] + random.real() * (box.high[axis] - box.low[axis]);
    const std::uint8_t starts = code.kinds.empty() ? 4 : 0;
    if (left == 0 || !(split > box.low[axis] && split < box.high[axis])) {
      code.kinds.push_back(static_cast<std::uint8_t>(3 + starts));
      return;
    }
    code.kinds.push_back(static_cast<std::uint8_t>(axis + starts));
    code.splits.push_back(split);
    Bounds low = box, high = box;
    low.high[axis] = high.low[axis] = split;
    const int below = random.below(left);
    self(self, low, below);
    self(self, high, left - 1 - below);
  };
  grow(grow, world, cuts);
  return treeFrom(code).value();
}

struct TreeCase {
  BinTree tree;
  LocalRay ray;
  double size;
};
TreeCase treeCase(HardRandom& random) {
  Box world;
  const double size = make(random, world);
  TreeCase c{randomTree(random, world.bounds(), 1 + random.below(12)), {}, size};
  // Aimed at planes, edges and corners of the tree.
  Box cell = world;
  const auto node = static_cast<std::uint32_t>(random.below(static_cast<int>(cellCount(c.tree))));
  const Bounds bounds = boundsOf(c.tree, CellId{node});
  for (int axis = 0; axis < 3; ++axis) {
    if (std::isfinite(bounds.low[axis])) cell.low[axis] = bounds.low[axis];
    if (std::isfinite(bounds.high[axis])) cell.high[axis] = bounds.high[axis];
  }
  c.ray = rayAt(random, cell, size);
  return c;
}

}  // namespace

void examineSlab(OracleReport& report, std::string_view name, std::uint64_t seed, std::uint64_t number) {
  HardRandom random(seed, number);
  Box box;
  const double size = make(random, box);
  // A second one, so that the boxes lie in a tree whose root is larger than they are.
  Box other;
  make(random, other);
  const Bounds items[] = {box.bounds(), other.bounds()};
  const LocalRay ray = rayAt(random, box, size);
  bool visited = false;
  const Bvh bvh(items);
  bvh.any(ray.origin, ray.direction, 0, kInfinity, [&](std::uint32_t first, std::uint32_t n) {
    for (std::uint32_t i = first; i < first + n; ++i) visited = visited || bvh.order()[i] == 0;
    return false;
  });
  Verdict verdict;
  ++report.questions;
  if (!visited) {
    ++report.doubtful;
    if (touchesExactly(items[0], ray)) verdict.fault = Fault::missed;
  }
  count(report, verdict, [&] { return story(name, seed, number, box, ray, verdict) + " (lost)"; });
}

// Every border lies where the exact plane is met, up to two roundings, and every cell that the exact ray goes through
// between two borders that differ by more than that is there.
void examineVoxel(OracleReport& report, std::string_view name, std::uint64_t seed, std::uint64_t number) {
  HardRandom random(seed, number);
  const TreeCase c = treeCase(random);
  const Line<Exact> line(c.ray);
  Verdict verdict;
  CellWalk walk(c.tree, c.ray.origin, c.ray.direction);
  WalkStep<CellId> step;
  double entered = 0;
  bool first = true;
  while (walk.next(step)) {
    ++report.questions;
    const Bounds cell = boundsOf(c.tree, step.where);
    if (step.tEnter != entered || (first && step.tEnter != 0)) verdict.fault = Fault::phantom;
    first = false;
    entered = step.tExit;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = c.ray.direction[axis], o = c.ray.origin[axis];
      // Somewhere in the step the exact ray is in the cell: enter <= its exit and exit >= its entry, on each axis.
      if (d == 0) {
        if (!(o >= cell.low[axis] && o < cell.high[axis])) verdict.fault = Fault::missed;
        continue;
      }
      const double near = d > 0 ? cell.low[axis] : cell.high[axis],
                   far = d > 0 ? cell.high[axis] : cell.low[axis];
      // In long double: an error of 2^-63 in a comparison that allows 2^-51.
      const auto at = [&](double plane) { return (static_cast<long double>(plane) - o) / d; };
      constexpr long double kSlack = 0x1p-51L;
      if (std::isfinite(near)) {
        const long double t = at(near);
        if (!(step.tExit >= t - kSlack * std::abs(t))) verdict.fault = Fault::missed;
        if (!(static_cast<long double>(step.tEnter) >= std::max(0.0L, t - kSlack * std::abs(t))))
          verdict.fault = Fault::missed;
      }
      if (std::isfinite(far)) {
        const long double t = at(far);
        if (!(static_cast<long double>(step.tExit) <= std::max(0.0L, t) + kSlack * std::abs(t)))
          verdict.fault = Fault::missed;
      }
    }
  }
  if (entered != kInfinity) verdict.fault = Fault::missed;
  count(report, verdict, [&] { return story(name, seed, number, c.tree, c.ray, verdict) + " (border)"; });
}

// A point that lies in the exact pyramid lies in a cell of the list.
void examinePyramid(OracleReport& report, std::string_view name, std::uint64_t seed, std::uint64_t number) {
  HardRandom random(seed, number);
  const TreeCase c = treeCase(random);
  const Vec3 apex = c.ray.origin;
  // Around the ray, from very thin to very wide; the ray itself may be a side.
  const Basis across = basisAround(c.ray.direction);
  const double wide = random.magnitude(1e-9, 2), aside = random.oneIn(2) ? 0 : wide;
  std::array<Vec3, 4> corners;
  for (int i = 0; i < 4; ++i)
    corners[static_cast<std::size_t>(i)] = c.ray.direction +
                                           (i == 1 || i == 2 ? wide : -aside) * across.first +
                                           (i >= 2 ? wide : -aside) * across.second;
  const std::vector<CellId> list = clipList(c.tree, pyramidOf(apex, corners));
  std::vector<bool> listed(cellCount(c.tree));
  for (const CellId cell : list) listed[static_cast<std::size_t>(cell)] = true;

  std::array<Point<Exact>, 4> inward;
  for (std::size_t k = 0; k < 4; ++k) {
    inward[k] = cross(Point<Exact>(corners[k]), Point<Exact>(corners[(k + 1) % 4]));
    if (dot(inward[k], Point<Exact>(corners[(k + 2) % 4])) < 0) inward[k] = Exact(-1) * inward[k];
  }

  Verdict verdict;
  for (int i = 0; i < 4; ++i) {
    Vec3 inside;
    for (const Vec3& corner : corners) inside = inside + random.share() * corner;
    const double far = c.size * random.magnitude(1e-4, 1e4);
    const Vec3 p = i == 0 ? apex : apex + far * inside;
    const Point<Exact> from = Point<Exact>(p) - Point<Exact>(apex);
    bool within = true;
    for (const Point<Exact>& side : inward) within = within && dot(side, from) >= 0;
    if (!within) continue;
    ++report.questions;
    std::uint32_t node = 0;
    while (!c.tree.nodes[node].leaf())
      node = p[c.tree.nodes[node].axis] < c.tree.nodes[node].split ? node + 1 : c.tree.nodes[node].high;
    if (!listed[c.tree.nodes[node].high]) verdict.fault = Fault::missed;
  }
  count(report, verdict, [&] {
    return story(name, seed, number, c.tree, c.ray, verdict) + " (a cell of the pyramid is lost)";
  });
}

}  // namespace rayshade
