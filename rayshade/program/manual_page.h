// The manual page of a program, from its options: `rayshade --manual-page >rayshade.1`.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace rayshade {

// In the language of man(7).  The description of the app is `name - what it does`, as in a manual page.
std::string manualPageOf(const CLI::App& app);

}  // namespace rayshade
