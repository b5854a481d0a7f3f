// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/host_program.h"

#include <cinttypes>

#include "pvm/host_task.h"
#include "pvm/pvm_link.h"
#include "pvm/virtual_machine.h"
#include "rayshade/interruption.h"
#include "rayshade/options.h"
#include "rayshade/progress.h"

namespace rayshade {
namespace {

struct HostProgramOptions {
  Options render;
  HostOptions host;
  MachineOptions machine;
};

void declareHostOptions(CLI::App& app, HostProgramOptions& o) {
  declareOptions(app, o.render);
  const std::string tasks = "Tasks";
  app.add_option("--hosts", o.machine.hostFile, "PVM host file; without: this machine alone")->group(tasks);
  app.add_flag("--missing-hosts", o.machine.allowMissingHosts, "go on without hosts that do not answer")->group(tasks);
  app.add_option("--voxels", o.host.wishes.voxels, "voxel-trace tasks (default: two per host)")
      ->check(CLI::Range(1, 4096))->group(tasks);
  app.add_option("--shades", o.host.wishes.shades, "shade tasks (default: one per four voxel-trace tasks)")
      ->check(CLI::Range(1, 4096))->group(tasks);
  app.add_option("--voxels-per-task", o.host.voxelsPerTask, "voxels that each voxel-trace task holds")
      ->check(CLI::Range(1, 64))->group(tasks);
  app.add_option("--window", o.host.window, "samples on their way at a time")->check(CLI::Range(1, 1 << 24))->group(tasks);
  app.add_flag("--mixed", o.host.mixedArithmetic, "go on when hosts compute different bits")->group(tasks);
}

double megabytes(std::uint64_t bytes) { return 1e-6 * static_cast<double>(bytes); }

void writeTable(std::FILE* to, const HostSummary& s, std::uint64_t pictureSum) {
  std::fprintf(to, "%-21s %-12s %9s %9s %10s %9s %9s %8s %8s %7s %7s %7s %7s\n", "task", "host", "objects", "rays",
               "visits", "hits", "shaded", "msg in", "msg out", "MB in", "MB out", "busy s", "peak MB");
  for (const TaskSummary& task : s.tasks) {
    const Report& r = task.report;
    const TraceCounts& c = r.counts;
    const std::string name = std::string(programName(task.placement.role)).substr(9) + " " +
                             std::to_string(task.placement.index);
    std::fprintf(to, "%-21s %-12.12s %9" PRIu64 " %9" PRIu64 " %10" PRIu64 " %9" PRIu64 " %9" PRIu64 " %8" PRIu64
                 " %8" PRIu64 " %7.1f %7.1f %7.2f %7.1f\n",
                 name.c_str(), task.placement.host.c_str(), task.objects,
                 c.transmittedRays + c.reflectedRays + c.shadowRays, c.visits, c.hits, r.combined, r.messagesIn,
                 r.messagesOut, megabytes(r.bytesIn), megabytes(r.bytesOut), r.busySeconds, megabytes(r.peakMemory));
  }
  double cpu = 0;
  for (const TaskSummary& task : s.tasks) cpu += task.report.cpuSeconds;
  std::fprintf(to, "host: %.1f MB in, %.1f MB out; at most %" PRIu64 " samples on their way; %.3f s start, %.3f s trace; "
               "tasks' CPU %.3f s\n",
               megabytes(s.traffic.bytesIn), megabytes(s.traffic.bytesOut), s.peakInFlight, s.startSeconds,
               s.traceSeconds, cpu);
  if (s.successions > 0)
    std::fprintf(to, "%d tasks died and were replaced, %" PRIu64 " samples issued again, %u epochs\n", s.successions,
                 s.reissued, s.epochs);
  std::fprintf(to, "picture checksum %016" PRIx64 "\n", pictureSum);
}

int run(HostProgramOptions& options) {
  // The first pass finds all that is wrong with the scene before anything is started.
  SurveySink surveySink({});
  SceneHead head = parseScene(options.render.parse, surveySink);
  applyOptions(options.render, head);
  Survey survey = surveySink.survey();
  if (survey.objects == 0) throw SceneError(sceneName(options.render) + ": error: there is nothing to be rendered");
  const View view = *viewOf(head.camera, head.picture);
  const PixelArea area = *pixelArea(head.picture);
  const std::string outputFile = chooseOutput(options.render, head);
  const bool quiet = options.render.quiet || head.report.quiet;

  ParseOptions again = options.render.parse;
  again.warn = nullptr;
  again.print = nullptr;
  const std::int32_t first = head.picture.firstFrame;
  auto open = [&](std::int32_t frame) {
    const std::string file = frameFile(outputFile, frame, head.picture.frames);
    std::optional<PictureFormat> format = options.render.format;
    if (options.render.sixteenBit && formatOf(file) == PictureFormat::png) format = PictureFormat::png16;
    return std::make_unique<PictureWriter>(file, area.width, area.height, head.picture.gamma, format);
  };
  std::unique_ptr<PictureWriter> writer = open(first);  // before any task is started

  VirtualMachine machine(options.machine);
  for (const std::string& host : machine.missingHosts())
    std::fprintf(stderr, "rayshade-host: warning: host %s did not join\n", host.c_str());
  PvmLink link;
  options.host.seed = options.render.seed;
  HostTask host(link, [&](SceneSink& sink) { parseScene(again, sink); }, survey, head.setting, options.host);
  Picture sum{area.width, area.height, {}};
  for (std::int32_t frame = first; frame < first + head.picture.frames; ++frame) {
    if (frame != first) writer = open(frame);
    ProgressLine progress(!quiet);
    host.renderFrame(
        view, head.picture, frame,
        [&](const std::vector<Color>& row) {
          writer->row(row);
          appendRow(sum, row);
        },
        [&](const HostTask::Progress& p) {
          checkInterruption();
          progress.show(p.rows, p.allRows, p.samples, "samples");
        });
    writer->finish();
    progress.clear();
    const std::uint64_t pictureSum = checksum(sum);
    sum.pixels.clear();
    if (frame == first + head.picture.frames - 1) {
      const HostSummary summary = host.finish();
      if (!quiet) writeTable(stderr, summary, pictureSum);
    }
  }
  return 0;
}

}  // namespace

int runHostProgram(int argc, char** argv) {
  CLI::App app("rayshade-host - renders a scene with many tasks on a PVM virtual machine", "rayshade-host");
  HostProgramOptions options;
  declareHostOptions(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  listenForInterruption();
  options.render.parse.warn = [&](const std::string& message) {
    if (!options.render.quiet) std::fprintf(stderr, "%s\n", message.c_str());
  };
  options.render.parse.print = [](const std::string& message) { std::fprintf(stderr, "%s\n", message.c_str()); };
  try {
    return run(options);
  } catch (const SceneError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rayshade-host: %s\n", error.what());
    return 1;
  }
}

}  // namespace rayshade
