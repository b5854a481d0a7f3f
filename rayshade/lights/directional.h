// A light so far away that its direction is the same everywhere.
//
//   directional x y z             the direction towards the light, any length
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/lights/light.h"

namespace rayshade {

struct DirectionalLight {
  Vec3 toward;  // unit

  static constexpr std::string_view keyword = "directional";
  static constexpr std::string_view examples[] = {"1 -1 2"};

  static std::optional<DirectionalLight> parse(Arguments& in) {
    const Vec3 v = in.vector();
    if (v == Vec3{}) in.fail("a directional light needs a direction other than 0 0 0");
    return DirectionalLight{normalize(v)};
  }
  int points() const { return 1; }
  LightSample sample(const LightQuery&, int) const { return {toward, toward, kInfinity, 1}; }
};

template <class Archive>
void serialize(Archive& archive, DirectionalLight& l) {
  archive(l.toward);
}

}  // namespace rayshade
