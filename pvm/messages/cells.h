// Work: objects that travel to whoever traces rays against them (Reinhard & Jansen, section 5).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/scene/items.h"
#include "rayshade/space/bintree.h"

namespace rayshade {

// From a task that traces with fetched cells, to the owner of the cell's voxel: its objects are wanted.
struct CellWanted {
  static constexpr bool isFact = false;
  CellId cell{};
};
// The answer to CellWanted: the objects of the cell.
struct CellItems {
  static constexpr bool isFact = false;
  CellId cell{};
  std::vector<Item> items;
};

struct CacheCounts {
  std::uint64_t asked = 0;    // look-ups
  std::uint64_t hits = 0;     // of those, found
  std::uint64_t fetched = 0;  // cells that came in
  std::uint64_t fetchedBytes = 0;
  std::uint64_t evicted = 0;
  std::uint64_t peakBytes = 0;  // held at a time
};

template <class Archive>
void serialize(Archive& archive, CellWanted& m) {
  archive(m.cell);
}

template <class Archive>
void serialize(Archive& archive, CellItems& m) {
  archive(m.cell, m.items);
}

template <class Archive>
void serialize(Archive& archive, CacheCounts& c) {
  archive(c.asked, c.hits, c.fetched, c.fetchedBytes, c.evicted, c.peakBytes);
}

}  // namespace rayshade
