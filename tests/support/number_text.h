// Numbers for scenes made by tests, with all their digits and blanks around them.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>

#include "rayshade/base/vec.h"

namespace rayshade {

inline std::string text(double x) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, " %.17g ", x);
  return buffer;
}
inline std::string text(Vec3 v) { return text(v.x) + text(v.y) + text(v.z); }

}  // namespace rayshade
