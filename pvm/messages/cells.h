// Work: objects that travel to whoever traces rays against them (Reinhard & Jansen, section 5).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/messages/addresses.h"
#include "rayshade/base/type_list.h"
#include "rayshade/scene/items.h"

namespace rayshade {

// From a task that traces with fetched cells, to the owner of the cell's voxel: its objects are wanted.  From the owner, to somebody
// who got them before: give them to the asker.  From him to the owner: he does not have them any more.
struct CellWanted {
  static constexpr bool isFact = false;
  static constexpr std::uint8_t tag = 15;
  CellId cell{};
  TaskId asker = kNobody;  // kNobody: the sender
};
// The answer to CellWanted: the objects of the cell.
struct CellItems {
  static constexpr bool isFact = false;
  static constexpr std::uint8_t tag = 16;
  CellId cell{};
  std::vector<Item> items;
};

struct CacheCounts {
  std::uint64_t lookups = 0;  // of a cell, by a ray
  std::uint64_t hits = 0;     // of those, found
  std::uint64_t fetched = 0;  // cells that came in
  std::uint64_t fetchedBytes = 0;
  std::uint64_t evicted = 0;
  std::uint64_t peakBytes = 0;  // held at a time
};

template <class Archive>
void serialize(Archive& archive, CellWanted& m) {
  archive(m.cell, m.asker);
}

template <class Archive>
void serialize(Archive& archive, CellItems& m) {
  archive(m.cell, m.items);
}

template <class Archive>
void serialize(Archive& archive, CacheCounts& c) {
  archive(c.lookups, c.hits, c.fetched, c.fetchedBytes, c.evicted, c.peakBytes);
}

using CellMessages = TypeList<CellWanted, CellItems>;

}  // namespace rayshade
