// BinTree: all of space, cut once.
//
// A tree of cuts by axis-aligned planes.  The root is all of R^3, so the outer cells reach to infinity and
// every point, every ray and every bounds is somewhere.  Leaves are cells; a voxel is a subtree, a box of one
// or several cells.  Both are numbered in tree order (low side first).  Cells are half-open, [low, high).
// A plane's coordinate exists once, in the tree, and the tree is sent to every task: nobody computes a border
// a second time.  All of it is a pure function of its arguments.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rayshade/base/archive.h"
#include "rayshade/base/bounds.h"
#include "rayshade/base/ids.h"
#include "rayshade/space/density.h"

namespace rayshade {

enum class CellId : std::uint32_t {};
enum class VoxelId : std::uint32_t {};

// Nodes lie in pre-order: the low child of an inner node is the next node, and the nodes of a subtree are
// neighbours.
struct BinNode {
  static constexpr std::uint32_t kNone = 0xffffffffu;

  double split = 0;             // world coordinate of the plane, of inner nodes
  std::uint32_t high = 0;       // inner node: its high child; leaf: its cell
  std::uint32_t voxel = kNone;  // the voxel that starts here
  std::uint8_t axis = 3;        // 0, 1, 2: cut by x, y, z = split; 3: a leaf

  bool leaf() const { return axis == 3; }
};

struct BinTree {
  std::vector<BinNode> nodes{BinNode{.voxel = 0}};  // one voxel, one cell
  std::vector<std::uint32_t> cellNodes{0};          // the leaf of each cell
  std::vector<std::uint32_t> voxelNodes{0};         // the root of each voxel
};

// No node of a tree has more ancestors: walks need no more memory than this.
inline constexpr int kMaxTreeDepth = 64;
inline constexpr std::uint32_t kMaxVoxels = 1u << 16;
inline constexpr std::uint32_t kMaxCells = 1u << 22;

struct TreeLimits {
  std::uint32_t voxels = 1;  // exactly so many, at least 1, at most kMaxVoxels
  std::uint32_t cells = 1;   // about so many in all (up to twice that), never fewer than voxels
};

// Work that is expected in a part of space, in any unit.
struct CostBox {
  Bounds box;  // of finite size
  double cost = 0;
};

// An object, or several alike, as it is held by every task whose voxels it touches.
struct HeldBox {
  Bounds box;  // padded
  double bytes = 0, objects = 1;
};
// What a voxel is to have, in proportion to the others; both above 0.
struct Portion {
  double bytes = 1, work = 1;
};

// Cuts the box `world` into voxels of equal size, each time across the longest side, in proportion to the
// voxels on each side; a world that is flat is cut along its other sides, one that is a point or empty or
// infinite is taken as a small box.  Then cuts each voxel into cells that hold about the same number of
// objects, at borders of the cubes of `density` and across the longest side where that separates something.
// With `costs`, the voxels are of about equal cost instead: each cut is moved along its axis until the costs on both sides
// are in that proportion, as far as both keep a sixteenth of the length.
BinTree buildBinTree(const Bounds& world, const TreeLimits& limits, DensityGrid& density,
                     std::vector<CostBox> costs = {});
BinTree buildBinTree(const Bounds& world, const TreeLimits& limits);

// The same with each cut where balance.h finds it best: first the bytes of `objects` are shared out, each counted wherever
// it is held, then `costs`.  `portions`: by voxel.
BinTree buildBalancedTree(const Bounds& world, std::uint32_t cells, DensityGrid& density,
                          std::span<const HeldBox> objects, std::vector<CostBox> costs,
                          std::span<const Portion> portions);

inline std::uint32_t cellCount(const BinTree& tree) {
  return static_cast<std::uint32_t>(tree.cellNodes.size());
}
inline std::uint32_t voxelCount(const BinTree& tree) {
  return static_cast<std::uint32_t>(tree.voxelNodes.size());
}

// Ids come from the tree itself, or were checked against its counts.
VoxelId voxelOfCell(const BinTree& tree, CellId cell);
CellId firstCellOfVoxel(const BinTree& tree, VoxelId voxel);  // its cells are numbered one after the other
Bounds boundsOf(const BinTree& tree, CellId cell);
Bounds boundsOf(const BinTree& tree, VoxelId voxel);

// Appends, in order, the voxels (cells) that the bounds touch; touching a plane from either side touches both
// sides.  The caller has padded the bounds.  Empty bounds touch nothing; NaN counts as infinite.
void voxelsTouching(const BinTree& tree, const Bounds& bounds, std::vector<VoxelId>& out);
void cellsTouching(const BinTree& tree, const Bounds& bounds, std::vector<CellId>& out);

// The tree in pre-order: everything else follows.
struct TreeCode {
  std::vector<std::uint8_t> kinds;  // per node: 0, 1, 2 a cut, 3 a leaf; + 4 where a voxel starts
  std::vector<double> splits;       // per cut
};
TreeCode describe(const BinTree& tree);
// Nothing unless the code is one complete tree of at most kMaxTreeDepth, every cut is strictly inside of what
// it cuts, and every cell is in exactly one voxel.
std::optional<BinTree> treeFrom(const TreeCode& code);

template <class Archive>
void serialize(Archive& archive, BinTree& tree) {
  if constexpr (Archive::kReading) {
    TreeCode code;
    archive(code.kinds, code.splits);
    std::optional<BinTree> read = treeFrom(code);
    if (!read) archive.fail();
    tree = read ? std::move(*read) : BinTree{};
  } else {
    const TreeCode code = describe(tree);
    archive(code.kinds, code.splits);
  }
}

}  // namespace rayshade
