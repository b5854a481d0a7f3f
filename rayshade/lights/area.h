// A parallelogram of light: nu times nv points, each anywhere in its own cell.
//
//   area  x1 y1 z1  x2 y2 z2 nu  x3 y3 z3 nv        three corners; nu points along 1-2, nv along 1-3   [world
//   units]
//
// All shadow rays of one hit to one area light start at the same place and end on the light: they are the
// light pyramid of Reinhard & Jansen, section 5.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/lights/light.h"

namespace rayshade {

struct AreaLight {
  Vec3 corner, edgeU, edgeV;
  int countU = 1, countV = 1;

  static constexpr std::string_view keyword = "area";
  static constexpr std::string_view examples[] = {"0 0 5  1 0 5 4  0 1 5 4"};
  static constexpr int kMostPoints = 1 << 16;

  static std::optional<AreaLight> parse(Arguments& in) {
    AreaLight light;
    light.corner = in.vector();
    light.edgeU = in.vector() - light.corner;
    light.countU = in.integer(kPositiveWholeNumber);
    light.edgeV = in.vector() - light.corner;
    light.countV = in.integer(kPositiveWholeNumber);
    if (light.countU > kMostPoints / light.countV) in.fail("an area light has at most 65536 samples");
    if (light.edgeU == Vec3{} || light.edgeV == Vec3{}) in.fail("a side of the area light has length 0");
    return light;
  }
  int points() const { return countU * countV; }
  LightExtent extent(Vec3) const { return {corner, edgeU, edgeV}; }

  LightSample sample(const LightQuery& query, int index) const {
    const auto number = static_cast<std::uint32_t>(index);
    const SquarePoint inCell = query.plan.anywhere(query.sample, query.key, query.plan.uses.light,
                                                   Dimension::lightU, Dimension::lightV, number);
    const double u = (index % countU + inCell.x) / countU, v = (index / countU + inCell.y) / countV;
    const Vec3 way = corner + u * edgeU + v * edgeV - query.position;
    const Vec3 toward = normalize(way);
    return {toward, toward, length(way), 1.0 / (countU * countV)};
  }
};

template <class Archive>
void serialize(Archive& archive, AreaLight& l) {
  archive(l.corner, l.edgeU, l.edgeV, l.countU, l.countV);
  if constexpr (Archive::kReading) {
    if (l.countU < 1 || l.countV < 1 || l.countU > AreaLight::kMostPoints / l.countV) {
      l.countU = l.countV = 1;
      archive.fail();
    }
  }
}

}  // namespace rayshade
