// The program rayshade-simulate: rayshade-host on a machine that is not there.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace rayshade {

inline constexpr std::string_view kSimulateProgram = "rayshade-simulate";

// Returns the exit status.
int runSimulateProgram(int argc, char** argv);

}  // namespace rayshade
