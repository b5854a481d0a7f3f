// Does this program compute the same bits as another, of another compiler or on another processor?
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace rayshade {

// A hash over results of all arithmetic that pictures depend on.  It should be the same everywhere (decision 24); tasks
// compare it, in case it is not.
std::uint64_t arithmeticFingerprint();

}  // namespace rayshade
