// Vectors and colours that must be alike, number by number.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include "rayshade/base/color.h"
#include "rayshade/base/vec.h"

namespace rayshade {

inline void expectNear(Vec3 got, Vec3 expected, double most = 1e-15) {
  EXPECT_NEAR(got.x, expected.x, most);
  EXPECT_NEAR(got.y, expected.y, most);
  EXPECT_NEAR(got.z, expected.z, most);
}
inline void expectNear(Color got, Color expected, double most = 1e-15) {
  expectNear(Vec3{got.r, got.g, got.b}, Vec3{expected.r, expected.g, expected.b}, most);
}

}  // namespace rayshade
