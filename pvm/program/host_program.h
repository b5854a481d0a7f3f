// The program rayshade-host: options, virtual machine, scene, picture, and the table at the end.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rayshade {

// Returns the exit status.
int runHostProgram(int argc, char** argv);

}  // namespace rayshade
