// A spherical light that casts soft shadows, one shadow ray for each sample of the pixel.
//
//   extended radius  x y z                                                                   [world units]
//
// Shading uses the centre; the shadow ray goes to a point of the square [-r, r]^2 across the line of sight.  As strata are, it
// is along the first axis in the row of the ray's sample, along the second in its column.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/lights/light.h"

namespace rayshade {

struct ExtendedLight {
  Vec3 centre;
  double radius = 0;

  static constexpr std::string_view keyword = "extended";
  static constexpr std::string_view examples[] = {"0.5  3 -4 5"};

  static std::optional<ExtendedLight> parse(Arguments& in) {
    const double radius = in.number();
    return ExtendedLight{in.vector(), radius};
  }
  int points() const { return 1; }
  LightExtent extent(Vec3 position) const {
    const auto [a, b] = basisAround(normalize(centre - position));
    return {centre - radius * a - radius * b, 2 * radius * a, 2 * radius * b};
  }

  LightSample sample(const LightQuery& query, int) const {
    const Vec3 way = centre - query.position;
    const Vec3 toward = normalize(way);
    const auto [a, b] = basisAround(toward);
    const SquarePoint at = query.plan.inStratum(query.sample, query.key, query.plan.uses.light,
                                                Dimension::lightV, Dimension::lightU);
    const double x = radius * (2 * at.y - 1), y = radius * (2 * at.x - 1);
    const Vec3 jittered = way + x * a + y * b;
    return {toward, normalize(jittered), length(jittered), 1};
  }
};

template <class Archive>
void serialize(Archive& archive, ExtendedLight& l) {
  archive(l.centre, l.radius);
}

}  // namespace rayshade
