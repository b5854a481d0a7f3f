// What `--version` says.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace rayshade {

// Name and version; for `--version` also the commit, if it was known when this was built, the processor for whose
// registers bundles of rays are traced here, and the fingerprint of the arithmetic, the same everywhere.
std::string nameAndVersion(const std::string& program);
std::string versionText(const std::string& program);

}  // namespace rayshade
