// The book keeping of shading: intersections that wait for their colours.
//
// "The order in which secondary rays are completed is indeterminate" (Reinhard & Jansen, section 3), and PVM keeps
// order between one pair of tasks only, so a colour can even overtake its intersection: a record is opened by whichever
// comes first.  It is closed when every slot that the intersection names is filled - slots are filled by name, so
// arrival decides when, never what.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <unordered_map>

#include "pvm/messages.h"

namespace rayshade {

struct Settled {
  Intersection hit;
  Gathered gathered;
  ReplyTo to;
};

class ShadeLedger {
 public:
  enum class Verdict : std::uint8_t { waiting, settled, refused };

  // `lightPoints`: how many an intersection must have.
  void begin(std::size_t lightPoints) {
    records_.clear();
    lightPoints_ = lightPoints;
  }

  // Verdict::settled: `out` has everything and the record is closed.  refused: the message makes no sense here.
  Verdict expect(Expect&& message, Settled& out);
  Verdict arrive(const Answer& message, Settled& out);

  std::size_t open() const { return records_.size(); }

 private:
  struct Record {
    std::optional<Expect> expected;
    Gathered gathered;
    std::vector<Slot> missing;  // once expected
    std::vector<Answer> early;  // until then
  };
  bool fill(Record& record, const Answer& answer);
  Verdict conclude(RecordId id, Record& record, Settled& out);

  std::unordered_map<RecordId, Record> records_;
  std::size_t lightPoints_ = 0;
};

}  // namespace rayshade
