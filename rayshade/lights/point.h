// A light at a point, the same in all directions and at all distances.
//
//   point x y z                                                                              [world units]
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/lights/light.h"

namespace rayshade {

struct PointLight {
  Vec3 position;

  static constexpr std::string_view keyword = "point";
  static constexpr std::string_view examples[] = {"3 -4 5"};

  static std::optional<PointLight> parse(Arguments& in) { return PointLight{in.vector()}; }
  int points() const { return 1; }

  LightSample sample(const LightQuery& query, int) const {
    const Vec3 way = position - query.position;
    const Vec3 toward = normalize(way);
    return {toward, toward, length(way), 1};
  }
};

template <class Archive>
void serialize(Archive& archive, PointLight& l) {
  archive(l.position);
}

}  // namespace rayshade
