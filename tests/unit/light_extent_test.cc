// Light pyramids: all shadow rays to a light with an extent end inside of what it says of that.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "rayshade/lights/all.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

TEST(LightExtent, AllPointsOfALightLieInIt) {
  SeededRandom random(5);
  for (int trial = 0; trial < 500; ++trial) {
    SCOPED_TRACE(trial);
    LightSource light;
    if (trial % 2 == 0) {
      light.kind = AreaLight{random.point(-3, 3), random.point(0.1, 2), {0.5, -random.real(0.5, 2), 1}, 3, 2};
    } else {
      light.kind = ExtendedLight{random.point(-3, 3), random.real(0.1, 2)};
    }
    const Vec3 from = random.point(-9, 9);
    const LightExtent extent = extentOf(light, from).value();
    const Vec3 across = cross(extent.edgeU, extent.edgeV);
    for (int index = 0; index < pointsOf(light); ++index) {
      const LightSample at =
          sampleLight(light, {from, RandomKey{static_cast<std::uint64_t>(trial)}, index, {}}, index);
      const Vec3 inside = from + at.shadowDistance * at.shadowToward - extent.corner;
      EXPECT_NEAR(dot(inside, normalize(across)), 0, 1e-9);
      const double u = dot(cross(inside, extent.edgeV), across) / dot(across, across);
      const double v = dot(cross(extent.edgeU, inside), across) / dot(across, across);
      for (const double share : {u, v}) {
        EXPECT_GE(share, -1e-9);
        EXPECT_LE(share, 1 + 1e-9);
      }
    }
  }
  EXPECT_FALSE(extentOf({PointLight{{1, 2, 3}}, kWhite, true}, {}));
}

}  // namespace
}  // namespace rayshade
