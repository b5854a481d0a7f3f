// A file of events: who did what when (docs/wire-format.md, "Files of events").
//
//   file  = "rayshade events 1\n", list of the names of messages by tag, lane*
//   lane  = u64 size in bytes, then task i32; role, machine string; index u32; clock i64; log
//
// in the encoding of rayshade/base/archive.h.  A lane is one task, or the program that renders alone; it is written when its task has ended.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>

#include "rayshade/events/event_record.h"

namespace rayshade {

struct EventLane {
  std::int32_t task = 0;  // as peers of events name it
  std::string role;       // "host", "voxel-trace" ...
  std::uint32_t index = 0;
  std::string machine;
  std::int64_t clock = 0;  // nanoseconds: to be added to its times, for those of the host
  EventLog log;

  std::string name() const { return role + " " + std::to_string(index); }
};

struct EventFile {
  std::vector<std::string> messages;  // names, by tag
  std::vector<EventLane> lanes;
};

void writeHead(std::FILE* to, const std::vector<std::string>& messages);
void writeLane(std::FILE* to, const EventLane& lane);

// Throws std::runtime_error: what is wrong, and at which byte.
EventFile readEvents(const std::string& fileName);

template <class Archive>
void serialize(Archive& archive, EventLane& lane) {
  archive(lane.task, lane.role, lane.index, lane.machine, lane.clock, lane.log);
}

}  // namespace rayshade
