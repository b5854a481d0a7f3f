// Seconds of a clock that only goes forward, the same for all processes of a machine.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace rayshade {

inline double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace rayshade
