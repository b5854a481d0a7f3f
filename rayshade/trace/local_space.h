// Space as one tracer knows it: what is local, and where there is something that is not.
//
// Most of what is local lies in one accelerator, or a few, that every ray is taken through: the objects of the voxels that are held
// here, cells that were joined.  The rest of space is cut into blocks, cells of other tasks' voxels that may be fetched.  Of every
// block the box around what is in it is known; its objects are local (a RegionRef) or not.  A task that fetches nothing knows of the
// voxels of others only where there is anything in them.  One process is the case of a single region and no block.
// A ray is traced through all that is local at once (trace_rays.h); whether that resolves it is asked here: could anything that
// is not local lie before what was found?  If so, the ray's walk says where it goes on.
//
// Example: voxels A and B side by side, A local.  A ray from A meets a sphere in A at t = 5; B's box begins at t = 7: resolved.
// Without the sphere it goes on in B, at the position of B on its walk.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "rayshade/intersect/bundle_hit.h"
#include "rayshade/space/voxel_bounds.h"

namespace rayshade {

// Some objects to be met, and the model they belong to; region null: not local.
struct RegionRef {
  const Model* model = nullptr;
  const Region* region = nullptr;
};

// Where a ray goes on: the first block of its walk that is not local and in which it might meet something.
struct NextBlock {
  CellId cell;         // what to fetch; the first of the voxel if nothing is fetched here
  VoxelId voxel;       // who holds it
  std::uint32_t step;  // of the voxel on the ray's walk
  double tEnter;       // before it all has been found that there is
};

enum class RayKind : std::uint8_t { nearest, shadow };

// What is known of the blocks of a tracer; not changed while rays are traced.
class BlockMap {
 public:
  static constexpr std::uint32_t kNoBlock = 0xffffffffu;
  struct Block {
    VoxelId voxel{};
    CellId cell{};
  };

  BlockMap() = default;
  // All of space is held.
  static BlockMap everything();
  // `cells`: by cell, the padded box around what is in it, in world space; empty: nothing.  `held`: by voxel.  `fetches`: cells
  // of others may become local.
  BlockMap(const BinTree& tree, std::span<const Bounds> cells, std::vector<bool> held, bool fetches);

  std::span<const Block> blocks() const { return blocks_; }
  // The boxes of blocks that are looked for one by one, and which those are, in the order of the leaves.
  const Bvh& bvh() const { return bvh_; }
  std::span<const std::uint32_t> inOrder() const { return inOrder_; }
  // The objects of these blocks are part of a whole region now.
  void join(const std::vector<bool>& joined);
  const Bounds& box(std::uint32_t block) const { return boxes_[block]; }
  // The block of a cell that may be fetched; kNoBlock if there is nothing in it, or it is part of a held voxel.
  std::uint32_t blockOf(CellId cell) const { return blockOfCell_[static_cast<std::size_t>(cell)]; }
  bool allHeld() const { return allHeld_; }
  bool fetches() const { return fetches_; }
  bool held(VoxelId voxel) const { return held_[static_cast<std::size_t>(voxel)]; }

  // Which segments might meet something, from begin[i] on, in a voxel of others of which nothing is ever local?
  RaySet reachingOthers(std::span<const Segment> segments, std::span<const double> begin) const;
  // Could the ray meet something in a voxel at t in [tMin, tMax]?  It may say yes too often.
  bool mayMeet(VoxelId voxel, const LocalRay& ray, double tMin, double tMax) const {
    return voxelBounds_.mayMeet(voxel, ray.origin, ray.direction, tMin, tMax);
  }

 private:
  std::vector<Block> blocks_;
  std::vector<Bounds> boxes_;  // by block
  Bvh bvh_;                    // of boxes_ of those in inOrder_
  std::vector<std::uint32_t> inOrder_, blockOfCell_;
  std::vector<bool> held_;   // by voxel
  VoxelBounds voxelBounds_;  // of all voxels
  Bvh others_;               // boxes of cells that are never local
  std::optional<Bounds>
      onlyVoxel_;  // the held one, if nothing is fetched; what stays inside of it is resolved
  bool allHeld_ = true, fetches_ = false;
};

class LocalSpace {
 public:
  virtual ~LocalSpace() = default;
  virtual const BinTree& tree() const = 0;
  virtual const BlockMap& blocks() const = 0;
  // What is local as a whole, for so many rays of a kind.
  virtual std::span<const RegionRef> whole(std::size_t rays, RayKind kind) = 0;
  // The objects of a block, for so many rays of a kind.
  virtual RegionRef region(std::uint32_t block, std::size_t rays, RayKind kind) = 0;
  // Is a block local?  The same without being a use of it.
  virtual bool isLocal(std::uint32_t block) const = 0;
};

// Where a ray goes on that might meet something at t in [begin, t] that is not local; nothing: there is no such thing.
// `begin`: what lies before has been looked at.
std::optional<NextBlock> nextBlock(const LocalSpace& space, const LocalRay& ray, double begin, double t);

// Where a ray enters the voxel at position `step` of its walk; infinite if the walk is shorter.
double walkedTo(const BinTree& tree, const Vec3& origin, const Vec3& direction, std::uint32_t step);

// Could a ray meet something in the box at t in [from, to]?  It may say yes too often.
bool mayMeet(const Bounds& box, const LocalRay& ray, double from, double to);

}  // namespace rayshade
