// The inner loop, shared by all programs: a ray goes from region to region.
//
// A ray's walk is the ordered list of voxels that it crosses, a pure function of the bin-tree and the ray; where it is
// on its walk is an integer.  In each voxel that is at hand the ray visits the objects and a hit is accepted if it
// lies before the exit of the voxel.  When a voxel is not at hand, the caller sends the ray and its position to the
// one who has it.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/intersect/model.h"
#include "rayshade/shading/shadow.h"
#include "rayshade/space/walk.h"

namespace rayshade {

// What has been counted while tracing.
struct TraceCounts {
  std::uint64_t primaryRays = 0, transmittedRays = 0, reflectedRays = 0, shadowRays = 0;
  std::uint64_t visits = 0, hits = 0;
  std::uint64_t tests = 0;  // objects tested by rays, shadow rays included
};

inline TraceCounts operator+(TraceCounts a, const TraceCounts& b) {
  a.primaryRays += b.primaryRays;
  a.transmittedRays += b.transmittedRays;
  a.reflectedRays += b.reflectedRays;
  a.shadowRays += b.shadowRays;
  a.visits += b.visits;
  a.hits += b.hits;
  a.tests += b.tests;
  return a;
}
template <class Archive>
void serialize(Archive& archive, TraceCounts& c) {
  archive(c.primaryRays, c.transmittedRays, c.reflectedRays, c.shadowRays, c.visits, c.hits, c.tests);
}

// The voxels that are at hand: null for those of others.
class VoxelSource {
 public:
  virtual ~VoxelSource() = default;
  virtual const Region* find(VoxelId voxel) const = 0;
  // Could the ray meet something at t in [tMin, tMax] in a voxel that is not at hand?  Yes, if nothing is known.
  virtual bool mayMeet(VoxelId, const Ray&, double /*tMin*/, double /*tMax*/) const { return true; }
};

struct Progress {
  enum class State : std::uint8_t { hit, left, elsewhere } state = State::left;
  Hit hit;                 // state == hit
  VoxelId voxel{};         // state == elsewhere: who has it must go on
  std::uint32_t step = 0;  // at this position of the walk
};

// Follows a ray from position `step` of its walk until it hits, leaves the scene or comes to a voxel that is not at
// hand.
Progress followRay(const BinTree& tree, const Model& model, const VoxelSource& voxels, const Ray& ray,
                   std::uint32_t step, TraceCounts& counts);

// The same for a shadow ray; `hit` means darkness, `left` that shadow.through is what arrives from the light.
Progress followShadow(const BinTree& tree, const Model& model, const VoxelSource& voxels, ShadowRay& shadow,
                      std::uint32_t step, const SceneSettings& settings, TraceCounts& counts);

}  // namespace rayshade
