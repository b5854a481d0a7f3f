// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/walk.h"

namespace rayshade {

namespace {

bool ends(const BinNode& node, VoxelId) { return node.voxel != BinNode::kNone; }
bool ends(const BinNode& node, CellId) { return node.leaf(); }
VoxelId idOf(const BinNode& node, VoxelId) { return VoxelId{node.voxel}; }
CellId idOf(const BinNode& node, CellId) { return CellId{node.high}; }

}  // namespace

template <class Id>
bool Walk<Id>::next(WalkStep<Id>& step) {
  if (size_ == 0) return false;
  auto [here, tExit] = stack_[--size_];
  for (;;) {
    const BinNode& node = tree_.nodes[here];
    if (ends(node, Id{})) {
      step = {idOf(node, Id{}), tEnter_, tExit};
      tEnter_ = tExit;
      return true;
    }
    const double origin = origin_[node.axis], direction = direction_[node.axis];
    const bool below = origin < node.split || (origin == node.split && direction < 0);
    const std::uint32_t first = below ? here + 1 : node.high, second = below ? node.high : here + 1;
    here = first;
    const bool crossed = origin < node.split ? direction > 0 : origin > node.split && direction < 0;
    if (!crossed) continue;
    const double ts = (node.split - origin) / direction;
    if (ts <= tEnter_) {
      here = second;
    } else if (ts < tExit) {
      stack_[size_++] = {second, tExit};
      tExit = ts;
    }
  }
}

template bool Walk<VoxelId>::next(WalkStep<VoxelId>&);
template bool Walk<CellId>::next(WalkStep<CellId>&);

}  // namespace rayshade
