// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/program/task_table.h"

#include <cinttypes>

#include "rayshade/base/memory.h"

namespace rayshade {
namespace {

struct Column {
  const char* name;
  std::string value;
};

std::string count(std::uint64_t value) { return std::to_string(value); }
std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6f", value);
  return text;
}

std::vector<Column> columns(const TaskSummary& task) {
  const Report& r = task.report;
  const TraceCounts& c = r.counts;
  return {{"role", roleName(task.placement.role)},
          {"index", count(task.placement.index)},
          {"machine", task.placement.host},
          {"objects", count(task.objects)},
          {"owned", count(task.owned)},
          {"primary", count(c.primaryRays)},
          {"transmitted", count(c.transmittedRays)},
          {"reflected", count(c.reflectedRays)},
          {"shadow", count(c.shadowRays)},
          {"visits", count(c.visits)},
          {"tests", count(c.tests)},
          {"hits", count(c.hits)},
          {"shaded", count(r.combined)},
          {"messagesIn", count(r.messagesIn)},
          {"messagesOut", count(r.messagesOut)},
          {"packetsIn", count(r.packetsIn)},
          {"packetsOut", count(r.packetsOut)},
          {"bytesIn", count(r.bytesIn)},
          {"bytesOut", count(r.bytesOut)},
          {"refused", count(r.refused)},
          {"stale", count(r.stale)},
          {"peakQueue", count(r.peakQueue)},
          {"modelBytes", count(r.modelBytes)},
          {"peakMemory", count(r.peakMemory)},
          {"busySeconds", seconds(r.busySeconds)},
          {"idleSeconds", seconds(r.idleSeconds)},
          {"waitSeconds", seconds(r.waitSeconds)},
          {"cpuSeconds", seconds(r.cpuSeconds)},
          {"cacheAsked", count(r.cache.lookups)},
          {"cacheHits", count(r.cache.hits)},
          {"cacheFetched", count(r.cache.fetched)},
          {"cacheFetchedBytes", count(r.cache.fetchedBytes)},
          {"cacheEvicted", count(r.cache.evicted)},
          {"cachePeakBytes", count(r.cache.peakBytes)},
          {"shadowCacheAsked", count(r.shadowCache.lookups)},
          {"shadowCacheHits", count(r.shadowCache.hits)},
          {"pyramids", count(r.pyramids)},
          {"pyramidRays", count(r.pyramidRays)},
          {"forwardedRays", count(r.forwardedRays)},
          {"cellsServed", count(r.cellsServed)}};
}

}  // namespace

void writeTable(std::FILE* to, const HostSummary& s, std::uint64_t pictureSum) {
  std::fprintf(to, "%-21s %-12s %9s %9s %10s %9s %9s %8s %8s %7s %7s %7s %7s %7s %7s\n", "task", "host",
               "objects", "rays", "visits", "hits", "shaded", "msg in", "msg out", "MB in", "MB out",
               "busy s", "idle s", "waiting", "peak MB");
  for (const TaskSummary& task : s.tasks) {
    const Report& r = task.report;
    const TraceCounts& c = r.counts;
    const std::string name = roleName(task.placement.role) + " " + std::to_string(task.placement.index);
    std::fprintf(to,
                 "%-21s %-12.12s %9" PRIu64 " %9" PRIu64 " %10" PRIu64 " %9" PRIu64 " %9" PRIu64 " %8" PRIu64
                 " %8" PRIu64 " %7.1f %7.1f %7.2f %7.2f %7" PRIu64 " %7.1f\n",
                 name.c_str(), task.placement.host.c_str(), task.objects,
                 c.primaryRays + c.transmittedRays + c.reflectedRays + c.shadowRays, c.visits, c.hits,
                 r.combined, r.messagesIn, r.messagesOut, megabytes(r.bytesIn), megabytes(r.bytesOut),
                 r.busySeconds, r.idleSeconds, r.peakQueue, megabytes(r.peakMemory));
  }
  for (const TaskSummary& task : s.tasks) {
    const Report& r = task.report;
    if (r.cache.fetched == 0 && r.pyramids == 0) continue;
    auto percent = [](std::uint64_t part, std::uint64_t whole) {
      return whole == 0 ? 100.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
    };
    std::fprintf(to,
                 "%s %u: cache %.2f %% hits (shadow rays %.2f %%), %" PRIu64
                 " cells fetched, %.2f MB, %" PRIu64 " thrown out",
                 programName(task.placement.role) + 9, task.placement.index,
                 percent(r.cache.hits, r.cache.lookups), percent(r.shadowCache.hits, r.shadowCache.lookups),
                 r.cache.fetched, megabytes(r.cache.fetchedBytes), r.cache.evicted);
    if (r.pyramids > 0)
      std::fprintf(to, "; %" PRIu64 " pyramids, %" PRIu64 " of %" PRIu64 " rays went on to the voxels",
                   r.pyramids, r.forwardedRays, r.pyramidRays);
    std::fprintf(to, "\n");
  }
  double cpu = 0;
  for (const TaskSummary& task : s.tasks) cpu += task.report.cpuSeconds;
  std::fprintf(to,
               "host: %.1f MB in, %.1f MB out; at most %" PRIu64
               " samples on their way; %.3f s start, %.3f s trace; "
               "tasks' CPU %.3f s\n",
               megabytes(s.host.report.bytesIn), megabytes(s.host.report.bytesOut), s.peakInFlight,
               s.startSeconds, s.traceSeconds, cpu);
  if (s.successions > 0)
    std::fprintf(to, "%d tasks died and were replaced, %" PRIu64 " samples issued again, %u epochs\n",
                 s.successions, s.reissued, s.epochs);
  std::fprintf(to, "picture checksum %016" PRIx64 "\n", pictureSum);
}

std::string taskTable(const HostSummary& summary, std::uint64_t pictureSum) {
  char sum[20];
  std::snprintf(sum, sizeof sum, "%016" PRIx64, pictureSum);
  std::string text = std::string("# checksum\t") + sum + "\n# objects\t" + count(summary.objects) +
                     "\n# startSeconds\t" + seconds(summary.startSeconds) + "\n# traceSeconds\t" +
                     seconds(summary.traceSeconds) + "\n# peakInFlight\t" + count(summary.peakInFlight) +
                     "\n# reissued\t" + count(summary.reissued) + "\n";
  auto addLine = [&text](const std::vector<Column>& row, auto field) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i > 0 ? "\t" : "") + std::string(field(row[i]));
    text += "\n";
  };
  const std::vector<Column> host = columns(summary.host);
  addLine(host, [](const Column& c) { return c.name; });
  addLine(host, [](const Column& c) { return c.value; });
  for (const TaskSummary& task : summary.tasks)
    addLine(columns(task), [](const Column& c) { return c.value; });
  return text;
}

}  // namespace rayshade
