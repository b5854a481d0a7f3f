// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/shade_task.h"

namespace rayshade {

void ShadeTask::on(TaskId from, Configure message) {
  desk_.outbox.beginEpoch(message.epoch);
  desk_.epoch = message.epoch;
  desk_.reportLoad(from, message.loadEvery);
  setting_ = std::move(message.setting);
  ledger_.begin(lightPointCount(setting_), finderCount(message.directory));
  desk_.link.connect(message.directory.voxelTasks);
  desk_.link.connect(message.directory.shadeTasks);
  desk_.outbox.post(from, Ready{message.epoch, arithmeticFingerprint(), 0, 0, 0});
}

void ShadeTask::on(TaskId from, Finish) {
  Report report = desk_.report();
  report.combined = combined_;
  desk_.outbox.post(from, report);
  desk_.finished = true;
}

void ShadeTask::on(TaskId from, Ping) {
  desk_.outbox.post(from, Pong{});
  desk_.outbox.flush();
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
  desk_.notePeak(ledger_.open());
  if (verdict == ShadeLedger::Verdict::refused) ++desk_.outbox.traffic.refused;
  if (verdict != ShadeLedger::Verdict::settled) return;
  ++combined_;
  const Settled& settled = ledger_.settled();
  const Color color = combine(settled.hit, settled.gathered, setting_);
  desk_.outbox.post(settled.to.task, Answer{settled.to.record, settled.to.slot, color});
}

}  // namespace rayshade
