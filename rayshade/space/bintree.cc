// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/bintree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "rayshade/base/elementary.h"
#include "rayshade/space/balance.h"

namespace rayshade {

namespace {

constexpr std::uint8_t kLeafKind = 3;
constexpr std::uint8_t kVoxelFlag = 4;

// A box that can be cut into kMaxVoxels: finite, and long enough in one direction for its numbers.
Bounds cuttable(const Bounds& world) {
  if (world.empty() || !world.finite()) return {{-1, -1, -1}, {1, 1, 1}};
  const double reach = std::max(maxAbs(world.low), maxAbs(world.high));
  // A number near the border of a double has no room for arithmetic around it.
  if (reach > 0x1p+1000) return {{-0x1p+1000, -0x1p+1000, -0x1p+1000}, {0x1p+1000, 0x1p+1000, 0x1p+1000}};
  if (reach < 0x1p-900) return {{-0x1p-900, -0x1p-900, -0x1p-900}, {0x1p-900, 0x1p-900, 0x1p-900}};
  const double least = reach * 0x1p-24;
  if (maxAbs(world.size()) >= least) return world;
  const Vec3 margin{least, least, least};
  return {world.low - margin, world.high + margin};
}

int longestAxis(const Vec3& size) {
  return size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
}

bool separates(const Bounds& box, int axis, double split) {
  return box.low[axis] < split && split < box.high[axis];
}

// What is shared out among voxels.
struct Contents {
  std::vector<CostBox> costs;
  std::vector<std::uint32_t> objects;  // by number
};

class Cutter {
 public:
  // Cubes of the density grid, as a range that is reordered while cutting.
  using Cubes = std::span<DensityGrid::Cube>;

  Cutter(double side, std::uint64_t cellObjects) : side_(side), cellObjects_(cellObjects) {}

  // Shares out objects: by voxel, which portion each is to have.
  void balance(std::span<const HeldBox> objects, std::span<const Portion> portions) {
    objects_ = objects;
    portions_ = portions;
    double bytes = 0;
    for (const HeldBox& object : objects) bytes += object.bytes;
    mostBytes_ = kFullest * bytes / bytesOf(portions_);
  }

  // `first`: the number of the first voxel.
  void cutVoxels(const Bounds& box, std::uint32_t first, std::uint32_t voxels, Cubes cubes, Contents contents,
                 int depth) {
    if (voxels == 1) {
      cutCells(box, cubes, depth, kVoxelFlag);
      return;
    }
    const auto [axis, split, below] = place(box, first, voxels, contents);
    const auto [low, high] = cut(box, axis, split, 0);
    const auto middle = std::partition(cubes.begin(), cubes.end(),
                                       [&, axis = axis, split = split](const DensityGrid::Cube& cube) {
                                         return (index(cube, axis) + 0.5) * side_ < split;
                                       });
    const auto count = static_cast<std::size_t>(middle - cubes.begin());
    auto [lowContents, highContents] = cutContents(std::move(contents), axis, split);
    cutVoxels(low, first, below, cubes.first(count), std::move(lowContents), depth + 1);
    cutVoxels(high, first + below, voxels - below, cubes.subspan(count), std::move(highContents), depth + 1);
  }

  TreeCode code;

 private:
  static std::int32_t index(const DensityGrid::Cube& cube, int axis) {
    return axis == 0 ? cube.x : axis == 1 ? cube.y : cube.z;
  }

  std::pair<Bounds, Bounds> cut(const Bounds& box, int axis, double split, std::uint8_t flag) {
    code.kinds.push_back(static_cast<std::uint8_t>(axis | flag));
    code.splits.push_back(split);
    Bounds low = box, high = box;
    low.high[axis] = high.low[axis] = split;
    return {low, high};
  }

  // What has been held twice further up leaves less for the cuts below: each may take its part of what is left.
  static constexpr double kFullest = 1.2;  // bytes of a voxel, in portions

  static double bytesOf(std::span<const Portion> portions) {
    double bytes = 0;
    for (const Portion& portion : portions) bytes += portion.bytes;
    return bytes;
  }

  // Where the box of some voxels is cut.
  Cut place(const Bounds& box, std::uint32_t first, std::uint32_t voxels, const Contents& contents) const {
    if (!contents.objects.empty()) {
      const auto portions = portions_.subspan(first, voxels);
      double bytes = 0;
      for (const std::uint32_t i : contents.objects) bytes += objects_[i].bytes;
      const double room = mostBytes_ * bytesOf(portions) / bytes;
      const double slack = room > 1 ? elementary::pow(room, 1.0 / std::bit_width(voxels - 1)) : 1;
      if (const auto cut = balancedCut(box, objects_, contents.objects, contents.costs, portions, slack))
        return *cut;
    }
    const std::uint32_t below = voxels / 2;
    const int axis = longestAxis(box.size());
    return {axis, splitAt(box, axis, static_cast<double>(below) / voxels, contents.costs), below};
  }

  // Where the box is cut so that `share` of the costs, or of the length when there are none, is on the low side.
  static double splitAt(const Bounds& box, int axis, double share, const std::vector<CostBox>& costs) {
    const double low = box.low[axis], length = box.high[axis] - low;
    double all = 0;
    for (const CostBox& c : costs) all += c.cost;
    if (!(all > 0 && all < kInfinity)) return low + length * share;
    double from = 1.0 / 16, to = 15.0 / 16;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (from + to);
      double below = 0;
      for (const CostBox& c : costs) below += c.cost * shareBelow(c.box, axis, low + length * middle);
      (below < share * all ? from : to) = middle;
    }
    return low + length * from;
  }

  // Costs are cut, objects are held on both sides.
  std::pair<Contents, Contents> cutContents(Contents contents, int axis, double split) const {
    Contents low, high;
    for (const CostBox& c : contents.costs) {
      const double share = shareBelow(c.box, axis, split);
      if (share > 0) low.costs.push_back({c.box, c.cost * share});
      if (share < 1) high.costs.push_back({c.box, c.cost * (1 - share)});
      if (share > 0 && share < 1) low.costs.back().box.high[axis] = high.costs.back().box.low[axis] = split;
    }
    for (const std::uint32_t i : contents.objects) {
      if (objects_[i].box.low[axis] <= split) low.objects.push_back(i);
      if (objects_[i].box.high[axis] >= split) high.objects.push_back(i);
    }
    return {std::move(low), std::move(high)};
  }

  void cutCells(const Bounds& box, Cubes cubes, int depth, std::uint8_t flag) {
    std::uint64_t objects = 0;
    for (const DensityGrid::Cube& cube : cubes) objects += cube.count;
    if (objects > cellObjects_ && depth < kMaxTreeDepth) {
      int order[3] = {0, 1, 2};
      const Vec3 size = box.size();
      std::stable_sort(order, order + 3, [&](int a, int b) { return size[a] > size[b]; });
      for (const int axis : order)
        if (const std::size_t below = balance(box, axis, objects, cubes)) {
          const double split = index(cubes[below], axis) * side_;
          const auto [low, high] = cut(box, axis, split, flag);
          cutCells(low, cubes.first(below), depth + 1, 0);
          cutCells(high, cubes.subspan(below), depth + 1, 0);
          return;
        }
    }
    code.kinds.push_back(kLeafKind | flag);
  }

  // Sorts the cubes along the axis; how many are below the border of cubes that balances the objects best and
  // is inside of the box; 0 when there is none.
  std::size_t balance(const Bounds& box, int axis, std::uint64_t objects, Cubes cubes) const {
    std::sort(cubes.begin(), cubes.end(), [&](const DensityGrid::Cube& a, const DensityGrid::Cube& b) {
      return index(a, axis) != index(b, axis) ? index(a, axis) < index(b, axis) : a < b;
    });
    std::size_t best = 0;
    std::uint64_t below = 0, bestLarger = objects;
    for (std::size_t i = 1; i < cubes.size(); ++i) {
      below += cubes[i - 1].count;
      if (index(cubes[i], axis) == index(cubes[i - 1], axis)) continue;
      if (!separates(box, axis, index(cubes[i], axis) * side_)) continue;
      const std::uint64_t larger = std::max(below, objects - below);
      if (larger < bestLarger) {
        bestLarger = larger;
        best = i;
      }
    }
    return best;
  }

  double side_;                // of a cube                                          [world units]
  std::uint64_t cellObjects_;  // a cell with more is cut, if it can be
  std::span<const HeldBox> objects_;
  std::span<const Portion> portions_;  // by voxel, of what is shared out
  double mostBytes_ = 0;               // of a portion of 1
};

template <class Id, class IsEnd, class Number>
void collect(const BinTree& tree, const Bounds& bounds, std::vector<Id>& out, IsEnd isEnd, Number numberOf) {
  if (bounds.low.x > bounds.high.x || bounds.low.y > bounds.high.y || bounds.low.z > bounds.high.z) return;
  std::uint32_t stack[kMaxTreeDepth + 1] = {0};
  int size = 1;
  while (size > 0) {
    std::uint32_t here = stack[--size];
    for (;;) {
      const BinNode& node = tree.nodes[here];
      if (isEnd(node)) {
        out.push_back(Id{numberOf(node)});
        break;
      }
      const bool low = !(bounds.low[node.axis] > node.split), high = !(bounds.high[node.axis] < node.split);
      if (low && high) stack[size++] = node.high;
      here = low ? here + 1 : node.high;
    }
  }
}

// The box of a node: all ancestors are met on the way down to it.
Bounds boundsOfNode(const BinTree& tree, std::uint32_t wanted) {
  Bounds box = kEverywhere;
  for (std::uint32_t here = 0; here != wanted;) {
    const BinNode& node = tree.nodes[here];
    const bool high = wanted >= node.high;
    (high ? box.low : box.high)[node.axis] = node.split;
    here = high ? node.high : here + 1;
  }
  return box;
}

}  // namespace

namespace {

// Everything but how the voxels are cut, which `prepare` tells the cutter.
template <class Prepare>
std::optional<BinTree> cutTree(const Bounds& world, const TreeLimits& limits, DensityGrid& density,
                               Contents contents, Prepare prepare) {
  const std::uint32_t voxels = std::clamp(limits.voxels, 1u, kMaxVoxels);
  const std::uint32_t cells = std::clamp(limits.cells, voxels, kMaxCells);
  std::vector<DensityGrid::Cube> cubes;
  std::uint64_t objects = 0;
  if (cells > voxels) cubes.assign(density.cubes().begin(), density.cubes().end());
  for (const DensityGrid::Cube& cube : cubes) objects += cube.count;
  Cutter cutter(density.side(), (objects + cells - 1) / cells);
  prepare(cutter);
  cutter.cutVoxels(world, 0, voxels, cubes, std::move(contents), 0);
  return treeFrom(cutter.code);
}

}  // namespace

BinTree buildBinTree(const Bounds& world, const TreeLimits& limits, DensityGrid& density,
                     std::vector<CostBox> costs) {
  const auto asItIs = [](Cutter&) {};
  const Bounds box = cuttable(world);
  // Costs in one point may ask for cuts that doubles cannot tell apart.
  if (!costs.empty())
    if (auto tree = cutTree(box, limits, density, {std::move(costs), {}}, asItIs)) return *tree;
  return cutTree(box, limits, density, {}, asItIs).value_or(BinTree{});
}

BinTree buildBalancedTree(const Bounds& world, std::uint32_t cells, DensityGrid& density,
                          std::span<const HeldBox> objects, std::vector<CostBox> costs,
                          std::span<const Portion> portions) {
  const TreeLimits limits{.voxels = static_cast<std::uint32_t>(portions.size()), .cells = cells};
  std::vector<std::uint32_t> all(objects.size());
  std::iota(all.begin(), all.end(), 0u);
  // What cannot be separated is left whole on one side of a plane beside it.
  const Bounds box = cuttable(world);
  const double beside = maxAbs(box.size()) / 16;
  const Vec3 margin{beside, beside, beside};
  if (auto tree =
          cutTree({box.low - margin, box.high + margin}, limits, density, {std::move(costs), std::move(all)},
                  [&](Cutter& cutter) { cutter.balance(objects, portions); }))
    return *tree;
  return buildBinTree(world, limits, density);
}

BinTree buildBinTree(const Bounds& world, const TreeLimits& limits) {
  DensityGrid none;
  return buildBinTree(world, limits, none);
}

VoxelId voxelOfCell(const BinTree& tree, CellId cell) {
  const std::uint32_t leaf = tree.cellNodes[number(cell)];
  const auto next = std::upper_bound(tree.voxelNodes.begin(), tree.voxelNodes.end(), leaf);
  return VoxelId{static_cast<std::uint32_t>(next - tree.voxelNodes.begin()) - 1};
}

CellId firstCellOfVoxel(const BinTree& tree, VoxelId voxel) {
  std::uint32_t here = tree.voxelNodes[number(voxel)];
  while (!tree.nodes[here].leaf()) ++here;
  return CellId{tree.nodes[here].high};
}

Bounds boundsOf(const BinTree& tree, CellId cell) { return boundsOfNode(tree, tree.cellNodes[number(cell)]); }
Bounds boundsOf(const BinTree& tree, VoxelId voxel) {
  return boundsOfNode(tree, tree.voxelNodes[number(voxel)]);
}

void voxelsTouching(const BinTree& tree, const Bounds& bounds, std::vector<VoxelId>& out) {
  collect(
      tree, bounds, out, [](const BinNode& node) { return node.voxel != BinNode::kNone; },
      [](const BinNode& node) { return node.voxel; });
}

void cellsTouching(const BinTree& tree, const Bounds& bounds, std::vector<CellId>& out) {
  collect(
      tree, bounds, out, [](const BinNode& node) { return node.leaf(); },
      [](const BinNode& node) { return node.high; });
}

TreeCode describe(const BinTree& tree) {
  TreeCode code;
  for (const BinNode& node : tree.nodes) {
    code.kinds.push_back(
        static_cast<std::uint8_t>(node.axis | (node.voxel != BinNode::kNone ? kVoxelFlag : 0)));
    if (!node.leaf()) code.splits.push_back(node.split);
  }
  return code;
}

std::optional<BinTree> treeFrom(const TreeCode& code) {
  struct Open {  // a subtree that is still to come
    Bounds box;
    std::uint32_t parent;  // the node whose high child it is, or kNone
    int depth;
    bool inVoxel;
  };
  if (code.kinds.size() != 2 * code.splits.size() + 1) return std::nullopt;
  BinTree tree{{}, {}, {}};
  std::vector<Open> open{{kEverywhere, BinNode::kNone, 0, false}};
  std::size_t split = 0;
  for (const std::uint8_t kind : code.kinds) {
    if (open.empty() || kind > (kLeafKind | kVoxelFlag)) return std::nullopt;
    Open here = open.back();
    open.pop_back();
    const auto index = static_cast<std::uint32_t>(tree.nodes.size());
    if (here.parent != BinNode::kNone) tree.nodes[here.parent].high = index;
    BinNode& node = tree.nodes.emplace_back();
    node.axis = kind & 3;
    if ((kind & kVoxelFlag) != 0) {
      if (here.inVoxel) return std::nullopt;
      here.inVoxel = true;
      node.voxel = voxelCount(tree);
      tree.voxelNodes.push_back(index);
    }
    if (node.leaf()) {
      if (!here.inVoxel) return std::nullopt;
      node.high = cellCount(tree);
      tree.cellNodes.push_back(index);
      continue;
    }
    if (here.depth == kMaxTreeDepth || split == code.splits.size()) return std::nullopt;
    node.split = code.splits[split++];
    if (!separates(here.box, node.axis, node.split)) return std::nullopt;
    Open high{here.box, index, here.depth + 1, here.inVoxel};
    Open low{here.box, BinNode::kNone, here.depth + 1, here.inVoxel};
    high.box.low[node.axis] = low.box.high[node.axis] = node.split;
    open.push_back(high);
    open.push_back(low);
  }
  if (!open.empty()) return std::nullopt;
  return tree;
}

}  // namespace rayshade
