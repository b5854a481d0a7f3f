// A point light with a cone.
//
//   spot  x y z  tx ty tz  coefficient [inner outer]        position, target, angles in degrees   [world
//   units]
//
// The factor is cos(theta)^coefficient, theta from the axis, 0 behind; between the two angles it falls off as
// h^2 (3 - 2 h), h linear in the cosine.  Without the angles rayshade takes both as 0, and the light is
// black.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

#include "rayshade/base/elementary.h"
#include "rayshade/lights/light.h"

namespace rayshade {

struct SpotLight {
  Vec3 position, axis;  // axis: unit
  double coefficient = 1;
  double cosineInner = 1, cosineOuter = 1;

  static constexpr std::string_view keyword = "spot";
  static constexpr std::string_view examples[] = {"0 0 5  0 0 0  1  20 30"};

  static std::optional<SpotLight> parse(Arguments& in) {
    SpotLight light;
    light.position = in.vector();
    const Vec3 way = in.vector() - light.position;
    light.coefficient = in.number({0, kExponent.most});
    double inner = 0, outer = 0;
    if (in.numberFollows()) {
      inner = in.number();
      outer = in.number();
    }
    if (way == Vec3{}) in.fail("a spot light needs a target other than its own place");
    if (inner > outer) in.fail("the inner angle of a spot light is larger than the outer one");
    light.axis = normalize(way);
    light.cosineInner = elementary::cos(inner * std::numbers::pi / 180);
    light.cosineOuter = elementary::cos(outer * std::numbers::pi / 180);
    return light;
  }
  int points() const { return 1; }

  LightSample sample(const LightQuery& query, int) const {
    const Vec3 way = position - query.position;
    const Vec3 toward = normalize(way);
    return {toward, toward, length(way), factorAt(-dot(toward, axis))};
  }

  double factorAt(double cosine) const {
    if (!(cosine > 0)) return 0;
    const double power = elementary::pow(cosine, coefficient);
    if (!(cosineInner > 0)) return power;
    if (cosine < cosineOuter) return 0;
    if (cosine > cosineInner) return power;
    if (!(cosineInner > cosineOuter)) return 0;
    const double h = (cosine - cosineOuter) / (cosineInner - cosineOuter);
    return power * h * h * (3 - 2 * h);
  }
};

template <class Archive>
void serialize(Archive& archive, SpotLight& l) {
  archive(l.position, l.axis, l.coefficient, l.cosineInner, l.cosineOuter);
}

}  // namespace rayshade
