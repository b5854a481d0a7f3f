// --table FILE: what each task did, for programs that read it.
//
// Tab-separated values.  A line of names first, then one line per task, the host task first; bytes, seconds and counts without
// units.  Lines that begin with # hold what concerns all: name, tab, value.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/host/summary.h"

namespace rayshade {

// `pictureSum`: checksum() of the last frame.
std::string taskTable(const HostSummary& summary, std::uint64_t pictureSum);

}  // namespace rayshade
