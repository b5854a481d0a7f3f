// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/program/task_render.h"

#include <memory>

#include "pvm/program/task_table.h"
#include "pvm/schedule/plan.h"
#include "rayshade/base/interruption.h"
#include "rayshade/program/frame_files.h"
#include "rayshade/program/output_file.h"
#include "rayshade/program/progress.h"
#include "rayshade/program/run.h"

namespace rayshade {
namespace {

// The first pass: how large the scene is, and what it uses.
class FirstPass final : public SceneSink {
 public:
  void surface(SurfaceId id, const Surface& surface) override { features.surface(id, surface); }
  void node(NodeId id, SceneNode node) override {
    features.count(node);
    survey.node(id, std::move(node));
  }
  void object(SceneObject object) override {
    features.count(object);
    survey.object(std::move(object));
  }
  void endOfStatement() override { survey.endOfStatement(); }

  SurveySink survey{{}};
  FeatureSink features;
};

// What needs memory, for the message when there is not enough.
struct Need {
  const char* what = "to read the scene";
  FirstPass pass;

  std::string story() const {
    return std::string(what) + ": the scene has " + std::to_string(pass.features.features().shapeCount()) +
           " shapes so far; " + memoryOfProcess();
  }
};

int run(HostProgramOptions& options, Stage& stage, Need& need) {
  // The first pass finds all that is wrong with the scene before anything is started.
  FirstPass& pass = need.pass;
  SceneHead head = parseScene(options.render.parse, pass);
  applyOptions(options.render, head);
  Survey survey = pass.survey.survey();
  if (survey.objects == 0)
    throw SceneError(sceneName(options.render) + ": error: there is nothing to be rendered");
  const View view = *viewOf(head.camera, head.picture);
  const SceneWork work = sceneWork(scenePlan(pass.features.features(), head), survey.objects);
  if (options.plan) {
    const std::vector<HostInfo> hosts = stage.planned();
    options.host.wishes.memory = stage.memories(hosts[0].name);
    const std::string why =
        applySchedule(options, {static_cast<std::uint32_t>(hosts.size()), stage.cores()}, survey.bytes);
    if (!why.empty()) std::printf("schedule        auto: %s\n", why.c_str());
    std::fputs(describePlan(hosts, options.host, std::move(survey), {view, head.picture}, head.settings, work)
                   .c_str(),
               stdout);
    return 0;
  }
  const PixelArea area = *pixelArea(head.picture);
  const FrameFiles files(options.render, head, stage.console());
  const bool quiet = options.render.quiet || head.report.quiet;

  ParseOptions again = options.render.parse;
  again.warn = nullptr;
  again.print = nullptr;
  const std::int32_t first = head.picture.firstFrame;
  // Whatever is to be written, before any task is started.
  std::unique_ptr<PictureWriter> writer = files.open(first);
  OutputFile table(options.tableFile), report(reportFile(options.render, head)),
      events(options.render.eventsFile);

  Machine& machine = stage.start();
  options.host.seed = options.render.seed;
  options.host.killAfter = options.patience;
  options.host.pingAfter = options.patience / 3;
  const std::vector<HostInfo> present = machine.hosts();
  const std::size_t hosts = present.size();
  options.host.wishes.memory = stage.memories(present[0].name);
  applySchedule(options, {static_cast<std::uint32_t>(hosts), machine.cores()}, survey.bytes);
  options.host.wishes = neededTasks(work, options.host, hosts).wishes;
  HostTask host(
      machine, [&](SceneSink& sink) { parseScene(again, sink); }, std::move(survey), head.settings,
      options.host);
  stage.hasHost(host);
  if (events) {
    writeHead(events.file(), messageNames());
    host.observe(kMostEvents, [&](const EventLane& lane) { writeLane(events.file(), lane); });
  }
  const std::int32_t everyRows = rowsBetweenLines(options.render, head);
  need.what = "for the picture";
  Picture sum{area.width, area.height, {}};
  for (std::int32_t frame = first; frame < first + head.picture.frames; ++frame) {
    if (frame != first) writer = files.open(frame);
    ProgressLine progress(!quiet);
    std::int32_t rows = 0;
    host.renderFrame(
        view, head.picture, frame,
        [&](const std::vector<Color>& row) {
          writer->row(row);
          appendRow(sum, row);
          if (everyRows > 0 && ++rows % everyRows == 0) sayLine(rows, area.height, area.width);
        },
        [&](const Completed& done) { progress.show(done); });
    writer->finish();
    progress.clear();
    if (!quiet && files.named()) std::fprintf(stderr, "wrote %s\n", placeOf(files.nameOf(frame)).c_str());
    const std::uint64_t pictureSum = checksum(sum);
    sum.pixels.clear();
    if (frame == first + head.picture.frames - 1) {
      const HostSummary summary = host.finish();
      if (!quiet) warnOfNotFinite(summary.notFinite);
      if (report) {
        writeTable(report.file(), summary, pictureSum);
      } else if (!quiet || options.render.verbose) {
        writeTable(stderr, summary, pictureSum);
      }
      if (table) std::fputs(taskTable(summary, pictureSum).c_str(), table.file());
      report.close();
      table.close();
      events.close();
    }
  }
  return 0;
}

}  // namespace

int runTaskRender(const std::string& program, HostProgramOptions& options, Stage& stage) {
  listenForInterruption();
  options.render.parse.warn = [&](const std::string& message) {
    if (!options.render.quiet) std::fprintf(stderr, "%s\n", message.c_str());
  };
  options.render.parse.print = [](const std::string& message) {
    std::fprintf(stderr, "%s\n", message.c_str());
  };
  Need need;
  return runProgram(
      program,
      [&] {
        // Before the program may die by a signal.
        const std::unique_ptr<Stage, void (*)(Stage*)> ending(&stage, [](Stage* s) { s->end(); });
        return run(options, stage, need);
      },
      [&] { return need.story(); });
}

}  // namespace rayshade
