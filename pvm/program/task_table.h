// What each task did: a table for people at the end of a render, and one for programs.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>

#include "pvm/host/summary.h"

namespace rayshade {

// `pictureSum`: checksum() of the last frame.
void writeTable(std::FILE* to, const HostSummary& summary, std::uint64_t pictureSum);

// --table FILE, for programs that read it: tab-separated values.  A line of names first, then one line per task, the host
// task first; bytes, seconds and counts without units.  Lines that begin with # hold what concerns all: name, tab, value.
std::string taskTable(const HostSummary& summary, std::uint64_t pictureSum);

}  // namespace rayshade
