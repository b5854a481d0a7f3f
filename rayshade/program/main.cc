// The program `rayshade`: one process, no PVM.
// SPDX-License-Identifier: BSD-3-Clause
#include <sys/resource.h>

#include <cinttypes>

#include "rayshade/base/interruption.h"
#include "rayshade/base/memory.h"
#include "rayshade/events/event_file.h"
#include "rayshade/program/command_line.h"
#include "rayshade/program/frame_files.h"
#include "rayshade/program/options.h"
#include "rayshade/program/output_file.h"
#include "rayshade/program/progress.h"
#include "rayshade/program/run.h"
#include "rayshade/program/scene_plan.h"
#include "rayshade/trace/render.h"

namespace {

using namespace rayshade;

struct Times {
  double read = 0, build = 0, trace = 0;
};

void writeReport(std::FILE* to, const Scene& scene, const FrameResult& result, const Times& times,
                 std::uint64_t pictureSum) {
  const TraceCounts& c = result.counts;
  const std::uint64_t all = c.primaryRays + c.transmittedRays + c.reflectedRays + c.shadowRays;
  auto line = [to](const char* what, std::uint64_t n) { std::fprintf(to, "%-24s %12" PRIu64 "\n", what, n); };
  line("eye rays", c.primaryRays);
  line("shadow rays", c.shadowRays);
  line("transmitted rays", c.transmittedRays);
  line("reflected rays", c.reflectedRays);
  line("all rays", all);
  line("hits", c.hits);
  line("supersampled pixels", result.samples.supersampled);
  line("samples in vain", result.samples.given - std::min(result.samples.given, result.samples.needed));
  std::fprintf(to, "%-24s %12.2f\n", "object tests per ray",
               static_cast<double>(c.tests) / static_cast<double>(std::max<std::uint64_t>(all, 1)));
  line("objects", scene.model.store().objectCount());
  std::fprintf(to, "%-24s %12.2f M\n", "rays per second",
               1e-6 * static_cast<double>(all) / std::max(times.trace, 1e-9));
  std::fprintf(to, "%-24s %8.3f read, %.3f build, %.3f trace\n", "seconds", times.read, times.build,
               times.trace);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::fprintf(to, "%-24s %8.1f scene, %.1f process at most\n", "megabytes", megabytes(scene.bytes()),
               1e-3 * static_cast<double>(usage.ru_maxrss));
  std::fprintf(to, "%-24s %016" PRIx64 "\n", "picture checksum", pictureSum);
}

// All threads are one lane.
void writeThreads(std::FILE* to, const std::vector<EventRecord>& records) {
  EventLane lane{0, "rayshade", 0, "", 0, {}};
  for (const EventRecord& record : records) lane.log.join(record.log());
  writeHead(to, {});
  writeLane(to, lane);
}

int printPlan(const Options& options) {
  FeatureSink sink;
  SceneHead head = parseScene(options.parse, sink);
  applyOptions(options, head);
  std::fputs(describe(scenePlan(sink.features(), head)).c_str(), stdout);
  return 0;
}

// What needs memory, for the message when there is not enough.
struct Need {
  const char* what = "to read the scene";
  Scene scene;

  std::string story() const {
    return std::string(what) + ": the scene has " +
           objectsAndBytes(scene.model.store().objectCount(), scene.bytes()) + " so far; " +
           memoryOfProcess();
  }
};

int run(const Options& options, Need& need) {
  Times times;
  double mark = steadySeconds();
  auto lap = [&mark] {
    const double now = steadySeconds(), spent = now - mark;
    mark = now;
    return spent;
  };

  Scene& scene = need.scene;
  SceneHead head = parseScene(options.parse, scene.model.store());
  applyOptions(options, head);
  if (scene.model.store().objectCount() == 0)
    throw SceneError(sceneName(options) + ": error: there is nothing to be rendered");
  scene.settings = head.settings;
  const View view = *viewOf(head.camera, head.picture);
  const PixelArea area = *pixelArea(head.picture);
  const FrameFiles files(options, head);
  times.read = lap();
  const bool quiet = options.quiet || head.report.quiet;
  const bool report = reportWanted(options, head);
  OutputFile reportTo(reportFile(options, head)), events(options.eventsFile);
  std::vector<EventRecord> records;
  for (unsigned thread = 0; events && thread < threadsOf(options); ++thread)
    records.emplace_back(kMostEvents, static_cast<std::uint16_t>(thread));
  const std::int32_t everyRows = rowsBetweenLines(options, head);
  const std::int32_t first = head.picture.firstFrame;
  for (std::int32_t frame = first; frame < first + head.picture.frames; ++frame) {
    const std::unique_ptr<PictureWriter> writer = files.open(frame);
    mark = steadySeconds();
    need.what = "to sort the objects of the scene";
    scene.prepare(exposureOf(head.picture, frame), 1, threadsOf(options));
    times.build = lap();
    ProgressLine progress(!quiet);
    need.what = "for the picture";
    Picture sum{area.width, area.height, {}};
    std::int32_t rows = 0;
    const FrameResult result = renderFrame(
        scene, {view, head.picture, options.seed}, frame, threadsOf(options),
        [&](const std::vector<Color>& row) {
          writer->row(row);
          if (report) appendRow(sum, row);
          if (everyRows > 0 && ++rows % everyRows == 0) sayLine(rows, area.height, area.width);
        },
        [&](const Sampler& sampler) { progress.show(sampler.completed()); }, records);
    writer->finish();
    times.trace = lap();
    progress.clear();
    if (!quiet) warnOfNotFinite(result.samples.notFinite);
    if (report) writeReport(reportTo ? reportTo.file() : stderr, scene, result, times, checksum(sum));
    if (options.verbose && files.named())
      std::fprintf(stderr, "wrote %s\n", placeOf(files.nameOf(frame)).c_str());
  }
  reportTo.close();
  if (events) writeThreads(events.file(), records);
  events.close();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("rayshade - renders a scene in the language of Rayshade 4", "rayshade");
  Options options;
  bool plan = false;
  declareOptions(app, options);
  app.add_flag("--plan", plan, "render nothing: print what the scene uses, and what is switched off")
      ->group("Messages");
  if (const std::optional<int> status = readCommandLine(app, argc, argv)) return *status;
  listenForInterruption();
  options.parse.warn = [&options](const std::string& message) {
    if (!options.quiet) std::fprintf(stderr, "%s\n", message.c_str());
  };
  options.parse.print = [](const std::string& message) { std::fprintf(stderr, "%s\n", message.c_str()); };
  Need need;
  return runProgram(
      "rayshade", [&] { return plan ? printPlan(options) : run(options, need); },
      [&] { return need.story(); });
}
