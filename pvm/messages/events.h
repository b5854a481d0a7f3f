// Facts: what was done when, if the host wants to know.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/type_list.h"
#include "rayshade/events/event_record.h"

namespace rayshade {

// Host to a task that has just begun, if events are wanted: note what you do, and keep so many of them.
struct Observe {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 26;
  std::uint32_t most = 0;
};
// The second answer to Finish, if events are wanted: what the task did when.
struct Observed {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 27;
  double begun = 0, now = 0;  // of its clock: when Observe came, when this goes
  EventLog log;
};

template <class Archive>
void serialize(Archive& archive, Observe& m) {
  archive(m.most);
}

template <class Archive>
void serialize(Archive& archive, Observed& m) {
  archive(m.begun, m.now, m.log);
}

using EventMessages = TypeList<Observe, Observed>;

}  // namespace rayshade
