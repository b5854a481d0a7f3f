// What the messages of a packet have in common is said once: rays and their colours say how they differ from the one before them.
//
// Rays that leave a task for the same voxel are of one kind as a rule, and their colours are awaited in records that follow each other.
// A ray is 59 bytes then instead of 107.  Whoever writes a packet, and whoever reads it, goes through it from its beginning with
// a memory of its own.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/messages/addresses.h"
#include "rayshade/optics/ray.h"

namespace rayshade {

struct PacketMemory {
  // Of the last ray: where its colour goes, and what it has in common with many others.
  ReplyTo to;
  Moment moment;
  int depth = 0, sample = 0;
  Color contribution = kWhite;
  double extinct = 1;
  // Of the last answer.
  RecordId answered = 0;
  Slot slot = 0;
  Color color;
};

// A record close to the one that is expected, in one of four forms, two bits.
enum class RecordForm : std::uint8_t { expected, near, far, anywhere };
constexpr RecordForm formOf(RecordId record, RecordId expected) {
  const auto ahead = static_cast<std::int64_t>(record - expected);
  return ahead == 0                                  ? RecordForm::expected
         : ahead == static_cast<std::int16_t>(ahead) ? RecordForm::near
         : ahead == static_cast<std::int32_t>(ahead) ? RecordForm::far
                                                     : RecordForm::anywhere;
}
template <class Archive>
void serializeRecord(Archive& archive, RecordId& record, RecordId expected, RecordForm form) {
  const auto ahead = [&]<class Ahead>(Ahead by) {
    if constexpr (!Archive::kReading) by = static_cast<Ahead>(record - expected);
    archive(by);
    if constexpr (Archive::kReading) record = expected + static_cast<RecordId>(std::int64_t{by});
  };
  switch (form) {
    case RecordForm::expected:
      record = expected;
      break;
    case RecordForm::near:
      ahead(std::int16_t{});
      break;
    case RecordForm::far:
      ahead(std::int32_t{});
      break;
    case RecordForm::anywhere:
      archive(record);
      break;
  }
}

// Messages that look at the one before them have a serialize() with the memory.
template <class Archive, class M>
void serializeInPacket(Archive& archive, M& message, PacketMemory& before) {
  if constexpr (requires { serialize(archive, message, before); }) {
    serialize(archive, message, before);
  } else {
    archive(message);
  }
}

}  // namespace rayshade
