// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/program/task_table.h"

#include <cinttypes>

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
  return {{"role", std::string(programName(task.placement.role)).substr(9)},
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
