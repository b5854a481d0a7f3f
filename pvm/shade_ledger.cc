// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/shade_ledger.h"

#include <algorithm>

namespace rayshade {
ShadeLedger::Verdict ShadeLedger::expect(Expect&& message, Settled& out) {
  if (message.hit.lit.size() != lightPoints_ || !knownFits(message)) return Verdict::refused;
  Gathered gathered = gatheredFrom(message);
  // Most intersections come with all their colours.
  const bool complete = message.pending.empty() && !message.hit.transmitted && !message.hit.reflected;
  if (complete) {
    out = {message.hit, gathered, message.to};
    return Verdict::settled;
  }
  const RecordId id = message.record;
  Record& record = records_[id];
  if (record.expected) return Verdict::refused;
  record.gathered = std::move(gathered);
  record.missing.assign(message.pending.begin(), message.pending.end());
  if (message.hit.transmitted) record.missing.push_back(kTransmittedSlot);
  if (message.hit.reflected) record.missing.push_back(kReflectedSlot);
  record.expected = std::move(message);
  for (const Answer& answer : record.early) fill(record, answer);
  record.early.clear();
  return conclude(id, record, out);
}

ShadeLedger::Verdict ShadeLedger::arrive(const Answer& message, Settled& out) {
  Record& record = records_[message.record];
  if (!record.expected) {
    record.early.push_back(message);
    return Verdict::waiting;
  }
  if (!fill(record, message)) return Verdict::refused;
  return conclude(message.record, record, out);
}

bool ShadeLedger::fill(Record& record, const Answer& answer) {
  const auto slot = std::find(record.missing.begin(), record.missing.end(), answer.slot);
  if (slot == record.missing.end()) return false;
  record.missing.erase(slot);
  if (answer.slot == kTransmittedSlot) {
    record.gathered.transmitted = answer.color;
  } else if (answer.slot == kReflectedSlot) {
    record.gathered.reflected = answer.color;
  } else {
    record.gathered.light[answer.slot] = answer.color;
  }
  return true;
}

ShadeLedger::Verdict ShadeLedger::conclude(RecordId id, Record& record, Settled& out) {
  if (!record.missing.empty()) return Verdict::waiting;
  out = {std::move(record.expected->hit), std::move(record.gathered), record.expected->to};
  records_.erase(id);
  return Verdict::settled;
}

}  // namespace rayshade
