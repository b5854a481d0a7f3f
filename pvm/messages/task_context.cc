// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/messages/task_context.h"

#include <sys/resource.h>

#include <algorithm>

namespace rayshade {

void TaskContext::flush() {
  if (loadEvery_ > 0) {
    const double now = link.now(), span = now - loadSent_;
    if (span >= loadEvery_) {
      outbox.post(loadTo_, Load{std::clamp(1 - (idleSeconds - idleThen_) / span, 0.0, 1.0)});
      loadSent_ = now;
      idleThen_ = idleSeconds;
    }
  }
  outbox.flush();
}

Report reportOf(const Traffic& t) {
  Report report;
  report.messagesIn = t.messagesIn;
  report.messagesOut = t.messagesOut;
  report.packetsIn = t.packetsIn;
  report.packetsOut = t.packetsOut;
  report.bytesIn = t.bytesIn;
  report.bytesOut = t.bytesOut;
  report.refused = t.refused;
  report.stale = t.stale;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  report.cpuSeconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  report.peakMemory = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  return report;
}

Report TaskContext::report() const {
  Report report = reportOf(outbox.traffic);
  report.peakQueue = peakQueue;
  report.idleSeconds = idleSeconds;
  report.busySeconds = link.now() - born_ - idleSeconds;
  return report;
}

}  // namespace rayshade
