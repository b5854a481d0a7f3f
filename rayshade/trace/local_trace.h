// Tracing with what is at hand: whole voxels of one's own, and cells of others that were fetched.
//
// The walk is the same as everywhere; only its grain differs.  A voxel is a subtree of the bin-tree, so the cells of a
// voxel follow each other on the walk and share its interval out among themselves: visiting the voxel as a whole or its
// cells one after the other finds the same hit.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/intersect/model.h"
#include "rayshade/shading/shadow.h"
#include "rayshade/space/walk.h"
#include "rayshade/trace/trace.h"

namespace rayshade {

// Some objects to visit, and the model they belong to; null: not at hand.
struct RegionRef {
  const Model* model = nullptr;
  const Region* region = nullptr;
};

class GroundSource {
 public:
  virtual ~GroundSource() = default;
  virtual RegionRef voxel(VoxelId voxel) = 0;  // one's own
  virtual RegionRef cell(CellId cell) = 0;     // fetched
  virtual bool fetches() { return true; }      // may there be fetched cells at all?
  // Could a ray meet something at t in [tMin, tMax] in a voxel that is not one's own?  Yes, if nothing is known.
  virtual bool mayMeet(VoxelId, const Ray&, double /*tMin*/, double /*tMax*/) { return true; }
};

struct LocalProgress {
  enum class State : std::uint8_t { hit, left, missing } state = State::left;
  Hit hit;                       // state == hit
  const Model* model = nullptr;  // of the hit
  // state == missing: the ray needs this cell, of this voxel, which is at this position of its walk through voxels.
  CellId cell{};
  VoxelId voxel{};
  std::uint32_t step = 0;
};

// `unit` counts the voxels and cells that were visited; the first `unit` of them are skipped, so a ray that missed
// something goes on where it was.
LocalProgress followLocally(const BinTree& tree, GroundSource& source, const Ray& ray, std::uint32_t& unit,
                            TraceCounts& counts);

// The same for a shadow ray; `hit` means darkness.  When something is missing `shadow` is as far as it came, and may be
// sent on to the voxel.
LocalProgress followLocally(const BinTree& tree, GroundSource& source, ShadowRay& shadow, std::uint32_t& unit,
                            const SceneSettings& settings, TraceCounts& counts);

}  // namespace rayshade
