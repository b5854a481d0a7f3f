// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/local_space.h"

#include <algorithm>

#include "rayshade/accel/bvh_bundle.h"
#include "rayshade/space/walk.h"

namespace rayshade {
namespace {

// Does this part of a ray lie well inside of a box?  As the box is convex, its ends tell; it may say no too often.
bool staysInside(const Bounds& box, const Segment& segment) {
  for (int axis = 0; axis < 3; ++axis) {
    const double origin = segment.ray.origin[axis], direction = segment.ray.direction[axis];
    for (const double t : {segment.tMin, segment.tMax}) {
      const double step = direction == 0 ? 0 : t * direction, at = origin + step;
      const double error = 4 * kRounding * (std::abs(origin) + std::abs(step));
      if (std::isfinite(box.low[axis]) && !(at - error > box.low[axis])) return false;
      if (std::isfinite(box.high[axis]) && !(at + error < box.high[axis])) return false;
    }
  }
  return true;
}

}  // namespace

// The slack is far more than the few roundings of (plane - origin) / direction.
bool mayMeet(const Bounds& box, const LocalRay& ray, double from, double to) {
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.low[axis], high = box.high[axis];
    if (!std::isfinite(low) || !std::isfinite(high)) continue;
    const double origin = ray.origin[axis], direction = ray.direction[axis];
    const double slack = 0x1p-44 * (std::abs(origin) + std::abs(low) + std::abs(high));
    const double toLow = low - slack - origin, toHigh = high + slack - origin;
    if (direction == 0) {
      if (toLow > 0 || toHigh < 0) return false;
      continue;
    }
    const double one = toLow / direction, other = toHigh / direction;
    from = std::max(from, std::min(one, other));
    to = std::min(to, std::max(one, other));
  }
  return !(from > to);
}

BlockMap BlockMap::everything() {
  BlockMap map;
  map.held_.push_back(true);
  return map;
}

BlockMap::BlockMap(const BinTree& tree, std::span<const Bounds> cells, std::vector<bool> held, bool fetches)
    : blockOfCell_(cellCount(tree), kNoBlock),
      held_(std::move(held)),
      voxelBounds_(tree, cells),
      fetches_(fetches) {
  std::vector<Bounds> ofOthers;
  for (std::uint32_t cell = 0; cell < cellCount(tree); ++cell) {
    const Bounds& box = cells[cell];
    const VoxelId voxel = voxelOfCell(tree, CellId{cell});
    if (box.empty() || this->held(voxel)) continue;
    allHeld_ = false;
    if (!fetches) {
      ofOthers.push_back(box);
      continue;
    }
    blockOfCell_[cell] = static_cast<std::uint32_t>(blocks_.size());
    boxes_.push_back(box);
    blocks_.push_back({voxel, CellId{cell}});
  }
  join(std::vector<bool>(blocks_.size()));
  others_ = Bvh(ofOthers);
  if (!fetches && std::count(held_.begin(), held_.end(), true) == 1)
    onlyVoxel_ = boundsOf(
        tree,
        VoxelId{static_cast<std::uint32_t>(std::find(held_.begin(), held_.end(), true) - held_.begin())});
}

void BlockMap::join(const std::vector<bool>& joined) {
  std::vector<std::uint32_t> single;
  for (std::uint32_t block = 0; block < blocks_.size(); ++block)
    if (!joined[block]) single.push_back(block);
  bvh_ = Bvh(single.size(), [&](std::uint32_t item) { return boxes_[single[item]]; });
  inOrder_ = bvh_.takeOrder();
  for (std::uint32_t& block : inOrder_) block = single[block];
}

RaySet BlockMap::reachingOthers(std::span<const Segment> segments, std::span<const double> begin) const {
  if (allHeld_ || fetches_) return 0;
  Segment open[kBundleSize];  // those that do not simply stay here
  std::size_t from[kBundleSize], count = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    Segment segment = segments[i];
    segment.tMin = std::max(segment.tMin, begin[i]);
    if (onlyVoxel_ && staysInside(*onlyVoxel_, segment)) continue;
    open[count] = segment;
    from[count++] = i;
  }
  RaySet reaching = 0;
  onProcessor(thisProcessor(), [&]() RAYSHADE_INLINE {
    others_.any(std::span(open).first(count), [&](std::uint32_t, std::uint32_t, RaySet rays) {
      forEachRay(rays, [&](std::size_t k) { reaching |= RaySet{1} << from[k]; });
      return rays;
    });
  });
  return reaching;
}

double walkedTo(const BinTree& tree, const Vec3& origin, const Vec3& direction, std::uint32_t step) {
  if (step == 0) return 0;
  const auto at = stepAt<VoxelId>(tree, origin, direction, step);
  return at ? at->tEnter : kInfinity;
}

std::optional<NextBlock> nextBlock(const LocalSpace& space, const LocalRay& ray, double begin, double t) {
  const BinTree& tree = space.tree();
  const BlockMap& map = space.blocks();
  VoxelWalk voxels(tree, ray.origin, ray.direction);
  std::optional<CellWalk> cells;  // begun when the first voxel comes that is not held
  WalkStep<VoxelId> at;
  WalkStep<CellId> cell;
  bool inCell = false;
  for (std::uint32_t step = 0; voxels.next(at) && at.tEnter <= t; ++step) {
    if (at.tExit <= begin || map.held(at.where)) continue;
    if (!map.mayMeet(at.where, ray, at.tEnter, std::min(at.tExit, t))) continue;
    if (!map.fetches()) return NextBlock{firstCellOfVoxel(tree, at.where), at.where, step, at.tEnter};
    if (!cells) {
      cells.emplace(tree, ray.origin, ray.direction);
      inCell = cells->next(cell);
    }
    while (inCell && voxelOfCell(tree, cell.where) != at.where) inCell = cells->next(cell);
    for (; inCell && voxelOfCell(tree, cell.where) == at.where && cell.tEnter <= t;
         inCell = cells->next(cell)) {
      if (cell.tExit <= begin) continue;
      const std::uint32_t block = map.blockOf(cell.where);
      if (block == BlockMap::kNoBlock || space.isLocal(block)) continue;
      if (mayMeet(map.box(block), ray, cell.tEnter, std::min(cell.tExit, t)))
        return NextBlock{cell.where, at.where, step, cell.tEnter};
    }
  }
  return std::nullopt;
}

}  // namespace rayshade
