// How much memory there is.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace rayshade {

std::uint64_t memoryOfMachine();  // bytes; 0: not known
std::uint64_t memoryLimit();      // of this process and of those that it starts, bytes; 0: none

constexpr double megabytes(double bytes) { return 1e-6 * bytes; }
std::string sayBytes(double bytes);  // 12.3 MB

// Tells the allocator to give large blocks back as soon as they are free, and to take no more for them than they need: what grew
// by being copied would else stay twice.
void keepMemoryTight();

}  // namespace rayshade
