// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/clip_list.h"

namespace rayshade {
namespace {

// The largest value of n.(p - apex) over the box; infinite sides give infinity where n points that way.
double farthest(const Bounds& box, Vec3 apex, Vec3 n) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (n[axis] == 0) continue;
    const double side = n[axis] > 0 ? box.high[axis] : box.low[axis];
    sum += n[axis] * (side - apex[axis]);
  }
  return sum;
}

// Is the whole box outside of the plane through the apex?  Rounding is on the side of "no".
bool outside(const Bounds& box, Vec3 apex, Vec3 inward) {
  if (inward == Vec3{}) return false;
  double reach = maxAbs(apex);
  for (int axis = 0; axis < 3; ++axis) {
    const double side = inward[axis] > 0 ? box.high[axis] : box.low[axis];
    if (std::isfinite(side)) reach = std::max(reach, std::abs(side));
  }
  return farthest(box, apex, inward) < -1e-12 * reach;
}

bool touches(const Pyramid& pyramid, const Bounds& box) {
  if (outside(box, pyramid.apex, pyramid.axis)) return false;
  for (const Vec3& side : pyramid.inward)
    if (outside(box, pyramid.apex, side)) return false;
  return true;
}

void collect(const BinTree& tree, const Pyramid& pyramid, std::uint32_t index, const Bounds& box,
             std::vector<CellId>& out) {
  if (!touches(pyramid, box)) return;
  const BinNode& node = tree.nodes[index];
  if (node.leaf()) {
    out.push_back(CellId{node.high});
    return;
  }
  Bounds low = box, high = box;
  low.high[node.axis] = node.split;
  high.low[node.axis] = node.split;
  const bool lowFirst = pyramid.apex[node.axis] < node.split;
  collect(tree, pyramid, lowFirst ? index + 1 : node.high, lowFirst ? low : high, out);
  collect(tree, pyramid, lowFirst ? node.high : index + 1, lowFirst ? high : low, out);
}

}  // namespace

Pyramid pyramidOf(Vec3 apex, const std::array<Vec3, 4>& corners) {
  Pyramid pyramid;
  pyramid.apex = apex;
  pyramid.axis = normalize(normalize(corners[0]) + normalize(corners[1]) + normalize(corners[2]) +
                           normalize(corners[3]));
  for (int i = 0; i < 4; ++i) {
    const Vec3 side = normalize(cross(corners[i], corners[(i + 1) % 4]));
    // Inside is where the opposite corners are; a side that the others do not agree on cuts nothing off.
    const double inner = dot(side, normalize(corners[(i + 2) % 4])),
                 inner2 = dot(side, normalize(corners[(i + 3) % 4]));
    if (inner > 0 && inner2 > 0) pyramid.inward[i] = side;
    if (inner < 0 && inner2 < 0) pyramid.inward[i] = -side;
    if (dot(pyramid.axis, corners[i]) <= 0) pyramid.axis = {};  // wider than a half-space
  }
  return pyramid;
}

Pyramid pyramidTo(Vec3 apex, Vec3 corner, Vec3 edgeU, Vec3 edgeV) {
  const Vec3 first = corner - apex;
  return pyramidOf(apex, {first, first + edgeU, first + edgeU + edgeV, first + edgeV});
}

std::vector<CellId> clipList(const BinTree& tree, const Pyramid& pyramid) {
  std::vector<CellId> cells;
  collect(tree, pyramid, 0, kEverywhere, cells);
  return cells;
}

}  // namespace rayshade
