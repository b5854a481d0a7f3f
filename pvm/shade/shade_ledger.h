// The book keeping of shading: intersections that wait for their colours.
//
// "The order in which secondary rays are completed is indeterminate" (Reinhard & Jansen, section 3), and PVM keeps
// order between one pair of tasks only, so a colour can even overtake its intersection: a record is opened by whichever
// comes first.  It is closed when every slot that the intersection names is filled - slots are filled by name, so
// arrival decides when, never what.
//
// The tasks that find intersections number them one by one, so a record's place follows from its number: a ring for each
// such task, no hash.  See recordOf().
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>

#include "pvm/messages/all.h"

namespace rayshade {

struct CompleteRecord {
  Intersection hit;
  Gathered gathered;
  ReplyTo to;
};

class ShadeLedger {
 public:
  enum class Verdict : std::uint8_t { waiting, complete, refused };

  // `lightPoints`: how many an intersection must have.  `finders`: how many tasks find intersections.
  void begin(std::size_t lightPoints, std::size_t finders);

  // Verdict::complete: complete() has everything and the record is closed.  refused: the message makes no sense here.
  Verdict expect(Expect&& message);
  Verdict arrive(RecordId record, Slot slot, Color color);

  // What was completed last, until the next call.
  const CompleteRecord& complete() const { return *last_; }
  std::size_t open() const { return open_; }

 private:
  static constexpr std::uint32_t kFarthest = 1u << 22;  // numbers ahead of the oldest open record
  static constexpr std::uint32_t kUnopened = 0xffffffffu, kClosed = 0xfffffffeu;

  struct Record {
    CompleteRecord content;
    bool expected = false;
    InlineVector<Slot, 8> missing;   // once expected
    std::vector<LightAnswer> early;  // until then
  };
  // Positions in records_, in the order of numbers from `first` on.
  struct Ring {
    std::uint64_t first = 0;
    std::deque<std::uint32_t> places;
  };

  Record* find(RecordId id);
  Verdict conclude(RecordId id, Record& record);
  static bool fill(Record& record, Slot slot, Color color);

  std::vector<Ring> rings_;          // by finder
  std::deque<Record> records_;       // stay where they are, and are used again
  std::vector<std::uint32_t> free_;  // of records_
  CompleteRecord atOnce_;            // an intersection that came with all its colours
  const CompleteRecord* last_ = &atOnce_;
  std::size_t open_ = 0;
  std::size_t lightPoints_ = 0;
};

}  // namespace rayshade
