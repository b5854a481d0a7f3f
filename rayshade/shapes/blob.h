// The blob: a smooth skin around metaballs.
//
//   blob threshold  (strength radius  x y z)+         strength, radius, threshold > 0         [object units]
//
// A metaball spreads the density strength (1 - d^2/radius^2)^2 at a distance d <= radius from its centre, and
// none farther away; the skin is where the densities add up to the threshold, denser inside.  Where a ray
// crosses the sphere of influence of a ball, at a and b, the density is strength ((t - a)(b - t)/radius^2)^2:
// a quartic.  The crossings of all balls cut the ray into intervals with one quartic each.  They are summed
// up in a tree over the intervals (a segment tree), so k balls cost k log k steps even if all overlap, and in
// Bernstein form, in which nothing cancels because all densities are positive.
// Sources: Blinn, A Generalization of Algebraic Surface Drawing, 1982, for the idea; Farin, Curves and
// Surfaces for CAGD, 1988, for blossoms and de Casteljau's subdivision.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "rayshade/shapes/shape.h"

namespace rayshade {

struct Metaball {
  Vec3 centre;
  double radius = 1;
  double strength = 1;
};

struct Blob {
  double threshold = 0.5;
  std::vector<Metaball> balls;

  static constexpr std::string_view keyword = "blob";
  static constexpr Aliases<> aliases{};
  static constexpr bool flat = false, unbounded = false, solid = true;
  static constexpr std::string_view examples[] = {"0.5  1 1  0 0 0", "0.45  1 0.9 -0.5 0 0  1 0.9 0.4 0 0",
                                                  "0.3  1 0.8 0 0 0  1 0.8 0.5 0 0.1  0.8 0.6 0.2 0.5 1e-3"};

  static std::optional<Blob> parse(Arguments& in);
  Bounds bounds() const;
  double intersect(const LocalRay& ray, double tMin) const;
  ShapePoint pointAt(const LocalRay& ray, double t) const;
  SurfaceCoordinates coordinates(const ShapePoint&, Vec3) const { return {}; }  // as in rayshade4: none
};

template <class Archive>
void serialize(Archive& archive, Metaball& m) {
  archive(m.centre, m.radius, m.strength);
}
template <class Archive>
void serialize(Archive& archive, Blob& b) {
  archive(b.threshold, b.balls);
}

}  // namespace rayshade
