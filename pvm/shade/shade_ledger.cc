// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/shade/shade_ledger.h"

#include <algorithm>

namespace rayshade {

void ShadeLedger::begin(std::size_t lightPoints, std::size_t finders) {
  lightPoints_ = lightPoints;
  rings_.assign(finders, {});
  records_.clear();
  free_.clear();
  last_ = &atOnce_;
  open_ = 0;
}

// The record of that number, opened if it was not yet; null when it is closed or cannot be.
ShadeLedger::Record* ShadeLedger::find(RecordId id) {
  const std::uint32_t finder = finderOf(id);
  const std::uint64_t number = numberOf(id);
  if (finder >= rings_.size()) return nullptr;
  Ring& ring = rings_[finder];
  if (number < ring.first || number - ring.first >= kFarthest) return nullptr;
  const std::uint64_t at = number - ring.first;
  if (at >= ring.places.size()) ring.places.resize(at + 1, kUnopened);
  std::uint32_t& place = ring.places[at];
  if (place == kClosed) return nullptr;
  if (place == kUnopened) {
    if (free_.empty()) {
      free_.push_back(static_cast<std::uint32_t>(records_.size()));
      records_.emplace_back();
    }
    place = free_.back();
    free_.pop_back();
    records_[place].expected = false;
    records_[place].early.clear();
    ++open_;
  }
  return &records_[place];
}

ShadeLedger::Verdict ShadeLedger::expect(Expect&& message) {
  // Whoever has added the lights says no more of them.
  if (message.hit.visibility.size() != lightPoints_ ||
      std::any_of(message.hit.visibility.begin(), message.hit.visibility.end(),
                  [](LightVisibility v) { return v > LightVisibility::traced; }))
    return Verdict::refused;
  // Many intersections come with all their colours.
  if (message.pending.empty() && !message.hit.back.transmitted && !message.hit.back.reflected) {
    atOnce_ = {std::move(message.hit), std::move(message.gathered), message.to};
    last_ = &atOnce_;
    return Verdict::complete;
  }
  Record* record = find(message.record);
  if (record == nullptr || record->expected) return Verdict::refused;
  record->expected = true;
  record->missing = message.pending;
  if (message.hit.back.transmitted) record->missing.push_back(kTransmittedSlot);
  if (message.hit.back.reflected) record->missing.push_back(kReflectedSlot);
  record->content = {std::move(message.hit), std::move(message.gathered), message.to};
  for (const LightAnswer& answer : record->early) fill(*record, answer.slot, answer.color);
  return conclude(message.record, *record);
}

ShadeLedger::Verdict ShadeLedger::arrive(RecordId id, Slot slot, Color color) {
  Record* record = find(id);
  if (record == nullptr) return Verdict::refused;
  if (!record->expected) {
    record->early.push_back({slot, color});
    return Verdict::waiting;
  }
  if (!fill(*record, slot, color)) return Verdict::refused;
  return conclude(id, *record);
}

bool ShadeLedger::fill(Record& record, Slot slot, Color color) {
  Slot* const at = std::find(record.missing.begin(), record.missing.end(), slot);
  if (at == record.missing.end()) return false;
  *at = record.missing[record.missing.size() - 1];
  record.missing.pop_back();
  Gathered& gathered = record.content.gathered;
  if (slot == kTransmittedSlot) {
    gathered.transmitted = color;
  } else if (slot == kReflectedSlot) {
    gathered.reflected = color;
  } else {
    gathered.light[slot] = color;
  }
  return true;
}

ShadeLedger::Verdict ShadeLedger::conclude(RecordId id, Record& record) {
  if (!record.missing.empty()) return Verdict::waiting;
  last_ = &record.content;
  Ring& ring = rings_[finderOf(id)];
  std::uint32_t& place = ring.places[numberOf(id) - ring.first];
  free_.push_back(place);
  place = kClosed;
  --open_;
  while (!ring.places.empty() && ring.places.front() == kClosed) {
    ring.places.pop_front();
    ++ring.first;
  }
  return Verdict::complete;
}

}  // namespace rayshade
