// What bash completes behind the name of a program, from its options: `rayshade --completions`.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace rayshade {

std::string completionsOf(const CLI::App& app);

}  // namespace rayshade
