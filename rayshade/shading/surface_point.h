// What is known of a hit once its geometry and textures have been looked at.  World space throughout.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/vec.h"
#include "rayshade/optics/surface.h"

namespace rayshade {

struct SurfacePoint {
  Vec3 position;
  Vec3 normal;           // for shading: interpolated, bumped (then not always unit); towards the viewer
  Vec3 geometricNormal;  // unit, of the surface itself; on the same side as `normal` was before textures
  bool smooth = false;   // the shape interpolates its normals
  bool entering = true;  // does the ray go into the solid here?
  double error = 0;      // the true surface is at most this far from `position`
  Surface surface;       // textures applied
};

// Where a ray that leaves the point in a direction starts: moved off the surface, to the side to which it goes, by
// twice the error of the position, so that it cannot meet the same surface again; no absolute distance is involved.
// Source: Pharr, Jakob & Humphreys, Physically Based Rendering, section 6.8 (bounded intersection error).
inline Vec3 originOff(const SurfacePoint& at, Vec3 direction) {
  const double side = dot(direction, at.geometricNormal) >= 0 ? 1.0 : -1.0;
  return at.position + (2 * at.error * side) * at.geometricNormal;
}

}  // namespace rayshade
