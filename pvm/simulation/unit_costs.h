// What a task's work costs: what it has counted, times nanoseconds for each.
//
// The units are measured on a real machine by regression over real runs (tests/bench/calibrate) and stand in a file of lines
// "name nanoseconds error"; what begins with # is a comment.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

#include "pvm/messages/control.h"

namespace rayshade {

// What is counted, with names as --table has them, or sums of those.
inline constexpr std::size_t kUnitCount = 13;
inline constexpr std::array<const char*, kUnitCount> kUnitNames{
    "rays",        "shadowRays", "visits",  "tests",    "hits",        "combined",    "messagesIn",
    "messagesOut", "packets",    "bytesIn", "bytesOut", "cellsServed", "fetchedBytes"};
using UnitCounts = std::array<double, kUnitCount>;

UnitCounts unitsOf(const Report& counted);

struct UnitCosts {
  UnitCounts nanoseconds{};

  double of(const Report& counted) const;
};

// Throws std::runtime_error: file, line and what is wrong.
UnitCosts readUnitCosts(const std::string& fileName);

}  // namespace rayshade
