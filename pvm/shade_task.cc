// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/shade_task.h"

namespace rayshade {

void ShadeTask::on(TaskId from, Configure message) {
  desk_.outbox.beginEpoch(message.epoch);
  desk_.epoch = message.epoch;
  desk_.reportLoad(from, message.loadEvery);
  setting_ = std::move(message.setting);
  ledger_.begin(lightPointCount(setting_));
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

void ShadeTask::on(TaskId, Expect message) {
  Settled settled;
  act(ledger_.expect(std::move(message), settled), settled);
}

void ShadeTask::on(TaskId, Answer message) {
  Settled settled;
  act(ledger_.arrive(message, settled), settled);
}

void ShadeTask::act(ShadeLedger::Verdict verdict, const Settled& settled) {
  desk_.notePeak(ledger_.open());
  if (verdict == ShadeLedger::Verdict::refused) ++desk_.outbox.traffic.refused;
  if (verdict != ShadeLedger::Verdict::settled) return;
  ++combined_;
  const Color color = combine(settled.hit, settled.gathered, setting_);
  desk_.outbox.post(settled.to.task, Answer{settled.to.record, settled.to.slot, color});
}

}  // namespace rayshade
