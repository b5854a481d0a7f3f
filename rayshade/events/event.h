// What was done when: one entry of a record of a render.
//
// A span has a begin and an end; what happens at once begins and ends at the same time.  What peer, number, count and amount mean
// depends on the kind: kEventKinds names them.  Times in nanoseconds of the clock of the task.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <compare>
#include <cstdint>

namespace rayshade {

enum class EventKind : std::uint8_t {
  trace,    // rays, of any tile
  shade,    // hits that were waiting, with what has come for them
  encode,   // a packet goes out
  content,  // what was in the packet that went out just before
  decode,   // a packet is read, and what it says is done
  wait,     // something is in hand, and what is missing has not come
  idle,     // nothing is in hand
  tile,     // a thread traces a tile, or samples that no tile has traced
  given,    // a tile to a task
  taken,    // a tile is back
  queue,    // so much waits
  cell,     // comes into the cache
  thrown,   // out of the cache
  epoch,    // begins
  death,    // of a task
};
inline constexpr std::size_t kEventKindCount = 15;

// The name of a kind and of its numbers; empty: it has none.
struct EventKindNames {
  const char *name, *peer, *number, *count, *amount;
};
inline constexpr std::array<EventKindNames, kEventKindCount> kEventKinds{{
    {"trace", "", "", "", ""},
    {"shade", "", "", "", ""},
    {"encode", "to", "packet", "messages", "bytes"},
    {"content", "to", "tag", "messages", "bytes"},
    {"decode", "from", "packet", "messages", "bytes"},
    {"wait", "", "", "", ""},
    {"idle", "", "", "", ""},
    {"tile", "", "tile", "x", "y"},
    {"given", "to", "tile", "x", "y"},
    {"taken", "from", "tile", "samples", ""},
    {"queue", "", "", "waiting", ""},
    {"cell", "", "cell", "", "bytes"},
    {"thrown", "", "", "cells", ""},
    {"epoch", "", "epoch", "", ""},
    {"death", "of", "", "", ""},
}};
constexpr const EventKindNames& namesOf(EventKind kind) {
  return kEventKinds[static_cast<std::size_t>(kind)];
}
// Says only how long something took.
constexpr bool isBareSpan(EventKind kind) {
  return kind <= EventKind::shade || kind == EventKind::wait || kind == EventKind::idle;
}

struct Event {
  std::uint64_t begin = 0, end = 0;
  EventKind kind{};
  std::uint16_t thread = 0;  // of the task; 0: the one that sends and receives
  std::int32_t peer = 0;     // another task
  std::uint32_t number = 0, count = 0;
  std::uint64_t amount = 0;

  friend bool operator==(const Event&, const Event&) = default;
};

// All events of a kind, with those that are not kept.
struct EventTotal {
  std::uint64_t events = 0, nanoseconds = 0, count = 0, amount = 0;

  friend bool operator==(const EventTotal&, const EventTotal&) = default;
};
using EventTotals = std::array<EventTotal, kEventKindCount>;

template <class Archive>
void serialize(Archive& archive, Event& e) {
  archive(e.begin, e.end, e.kind, e.thread, e.peer, e.number, e.count, e.amount);
  if constexpr (Archive::kReading)
    if (static_cast<std::size_t>(e.kind) >= kEventKindCount || e.end < e.begin) archive.fail();
}

template <class Archive>
void serialize(Archive& archive, EventTotal& t) {
  archive(t.events, t.nanoseconds, t.count, t.amount);
}

}  // namespace rayshade
