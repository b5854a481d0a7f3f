// Space as one task knows it: patches with objects in them, some at hand and some elsewhere.
//
// A patch is a voxel of one's own or a cell of somebody else's.  Of every patch the box around what is in it is known; the
// objects may be here (a RegionRef) or not.  A bundle of rays goes through all patches at once, near to far.  A ray is
// settled when nothing in a patch that is not here could change what it has found.  The others must go step by step
// (local_trace.h), which says where to; so a patchwork decides how fast an answer comes, never what it is.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/intersect/bundle_hit.h"
#include "rayshade/trace/local_trace.h"

namespace rayshade {

class PatchSource {
 public:
  virtual ~PatchSource() = default;
  // The objects of a patch, for so many rays; null: not here.
  virtual RegionRef patch(std::uint32_t number, std::size_t rays) = 0;
};

class Patchwork {
 public:
  Patchwork() = default;
  // `boxes`: by patch, the padded box around what is in it; world space.
  explicit Patchwork(std::vector<Bounds> boxes) : boxes_(std::move(boxes)), bvh_(boxes_) {}

  struct Found {
    Hit hit;
    const Model* model = nullptr;  // of the hit
    bool settled = true;           // else something that is not here might be nearer
  };
  // The nearest hits of at most kBundleSize segments, whose tMax become the t of the hits.  What is not here counts
  // from `begin[i]` on.
  void visit(PatchSource& source, std::span<Segment> segments, std::span<const double> begin,
             std::span<Found> found, TraceCounts& counts, Processor processor = thisProcessor()) const;

  enum class Light : std::uint8_t {
    dark,      // something opaque is before it
    clear,     // nothing is
    filtered,  // something transparent is
    missing,   // nothing that is here is, but something that is not here might be
  };
  // Which of at most kBundleSize segments could meet something in any of the patches, wherever that is?
  RaySet touching(std::span<Segment> segments, Processor processor = thisProcessor()) const;

  // What becomes of at most kBundleSize shadow rays.
  void obstruct(PatchSource& source, std::span<Segment> segments, std::span<const double> begin,
                std::span<Light> light, TraceCounts& counts, Processor processor = thisProcessor()) const;

 private:
  struct Missing {
    std::uint32_t patch;
    RaySet rays;  // that came to it
  };
  RaySet unsettled(std::span<const Missing> missing, std::span<const Segment> segments,
                   std::span<const double> begin) const;

  std::vector<Bounds> boxes_;
  Bvh bvh_;
};

// Could a ray meet something in the box at t in [from, to]?  It may say yes too often.
bool mayMeet(const Bounds& box, const LocalRay& ray, double from, double to);

}  // namespace rayshade
