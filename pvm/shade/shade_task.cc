// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/shade/shade_task.h"

#include "rayshade/base/arithmetic.h"

namespace rayshade {

void ShadeTask::on(TaskId from, Configure message) {
  context_.beginEpoch(from, message);
  settings_ = std::move(message.settings);
  ledger_.begin(lightPointCount(settings_), finderCount(message.directory));
  context_.outbox.post(from, Ready{message.epoch, arithmeticFingerprint(), 0, 0, 0});
}

Report ShadeTask::counted() const {
  Report report = context_.counted();
  report.combined = combined_;
  return report;
}

void ShadeTask::on(TaskId from, Finish) {
  context_.close();
  context_.outbox.post(from, context_.closed(counted()));
  context_.finished = true;
}

void ShadeTask::on(TaskId from, Ping) {
  context_.outbox.post(from, Pong{});
  context_.outbox.flush();
}

void ShadeTask::on(TaskId, Expect&& message) { act(ledger_.expect(std::move(message))); }

void ShadeTask::on(TaskId, const Answer& message) {
  act(ledger_.arrive(message.record, message.slot, message.color));
}

void ShadeTask::on(TaskId, const LightAnswers& message) {
  for (const LightAnswer& answer : message.colors)
    act(ledger_.arrive(message.record, answer.slot, answer.color));
}

void ShadeTask::act(ShadeLedger::Verdict verdict) {
  context_.notePeak(ledger_.open());
  if (verdict == ShadeLedger::Verdict::refused) ++context_.outbox.traffic.refused;
  if (verdict != ShadeLedger::Verdict::complete) return;
  ++combined_;
  const CompleteRecord& complete = ledger_.complete();
  const Color color = combine(complete.hit, complete.gathered, settings_);
  context_.outbox.post(complete.to.task, Answer{complete.to.record, complete.to.slot, color});
}

}  // namespace rayshade
