// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/program/host_program.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cinttypes>
#include <fstream>

#include "pvm/host/host_task.h"
#include "pvm/link/pvm_link.h"
#include "pvm/link/virtual_machine.h"
#include "pvm/program/task_table.h"
#include "pvm/schedule/plan.h"
#include "rayshade/base/interruption.h"
#include "rayshade/program/options.h"
#include "rayshade/program/output_file.h"
#include "rayshade/program/progress.h"

namespace rayshade {
namespace {

struct HostProgramOptions {
  Options render;
  HostOptions host;
  MachineOptions machine;
  bool plan = false;
  std::string tableFile;
  std::string schedule = "data", split = "equal";
  std::optional<std::uint32_t> pyramids;
  std::optional<std::string> horizon, shadows, shading;
  std::optional<double> cacheMegabytes;
  double patience = HostOptions{}.killAfter;
};

// A schedule is a preset; what is said in detail counts more.
void applySchedule(HostProgramOptions& o, std::uint32_t hosts) {
  HostOptions& host = o.host;
  DemandPolicy& policy = host.policy;
  if (o.schedule == "hybrid") {
    host.wishes.pyramids = 2 * hosts;
    policy.shadows = ShadowPolicy::automatic;
  } else if (o.schedule == "pipelined") {
    host.wishes.pyramids = 2 * hosts;
    policy.shadows = ShadowPolicy::automatic;
    policy.horizon = {Horizon::Kind::cells, 1e9};
  } else if (o.schedule == "demand") {
    host.wishes.pyramids = 2 * hosts;
    policy.horizon = {Horizon::Kind::cells, 1e9};
    policy.shadows = ShadowPolicy::local;
    policy.secondariesTravel = false;
  }
  host.split = o.split == "cost" ? Split::cost : Split::equal;
  policy.shadeLocally = o.shading ? *o.shading == "local" : o.schedule != "data";
  // Every cluster has somebody to work for.
  if (host.wishes.pyramids > 0) host.wishes.pyramids = std::max(host.wishes.pyramids, host.wishes.clusters);
  if (o.pyramids) host.wishes.pyramids = *o.pyramids;
  if (o.shadows) {
    policy.shadows = *o.shadows == "forward" ? ShadowPolicy::forward
                     : *o.shadows == "local" ? ShadowPolicy::local
                                             : ShadowPolicy::automatic;
  }
  if (o.cacheMegabytes) policy.cacheBytes = static_cast<std::uint64_t>(*o.cacheMegabytes * 1e6);
  if (o.horizon && *o.horizon != "auto") {
    char* end = nullptr;
    const double value = std::strtod(o.horizon->c_str(), &end);
    const bool inCells = *end == 'c';
    if (end == o.horizon->c_str() || end[inCells ? 1 : 0] != '\0' || !(value >= 0))
      throw HostError("--horizon is auto, a number of cells (12c) or a distance (3.5), not " + *o.horizon);
    policy.horizon = {inCells ? Horizon::Kind::cells : Horizon::Kind::distance, value};
  }
}

void declareHostOptions(CLI::App& app, HostProgramOptions& o) {
  declareOptions(app, o.render);
  const std::string tasks = "Tasks";
  app.add_option("--hosts", o.machine.hostFile, "PVM host file; without: this machine alone")->group(tasks);
  app.add_flag("--missing-hosts", o.machine.allowMissingHosts, "go on without hosts that do not answer")
      ->group(tasks);
  app.add_option("--voxels", o.host.wishes.voxels, "voxel-trace tasks (default: two per host)")
      ->check(CLI::Range(1, 4096))
      ->group(tasks);
  app.add_option("--shades", o.host.wishes.shades, "shade tasks (default: one per four voxel-trace tasks)")
      ->check(CLI::Range(1, 4096))
      ->group(tasks);
  app.add_option("--voxels-per-task", o.host.voxelsPerTask, "voxels that each voxel-trace task holds")
      ->check(CLI::Range(1, 64))
      ->group(tasks);
  app.add_option("--split", o.split, "voxels of equal size, or of equal predicted cost")
      ->check(CLI::IsMember({"equal", "cost"}))
      ->group(tasks);
  app.add_option("--pyramids", o.pyramids, "pyramid-trace tasks (default: by the schedule)")
      ->check(CLI::Range(0, 4096))
      ->group(tasks);
  app.add_option("--clusters", o.host.wishes.clusters,
                 "copies of the model, each distributed over voxel-trace tasks")
      ->check(CLI::Range(1, 64))
      ->group(tasks);
  const std::string sharing = "What travels: rays or objects";
  app.add_option("--schedule", o.schedule,
                 "data: all rays travel; hybrid: primary and shadow rays are traced where they begin, with "
                 "fetched cells; "
                 "pipelined: more of that, farther; demand: every ray, nothing travels but objects")
      ->check(CLI::IsMember({"data", "hybrid", "pipelined", "demand"}))
      ->group(sharing);
  app.add_option("--horizon", o.horizon,
                 "how far pyramids go: auto, a number of cells (12c), a distance (3.5)")
      ->group(sharing);
  app.add_option("--shadows", o.shadows, "shadow rays: forward, local or auto")
      ->check(CLI::IsMember({"forward", "local", "auto"}))
      ->group(sharing);
  app.add_option(
         "--shading", o.shading,
         "separate: always by shade tasks; local: by the task that found the hit, if nothing of it leaves")
      ->check(CLI::IsMember({"separate", "local"}))
      ->group(sharing);
  app.add_option("--cache", o.cacheMegabytes, "object cache of each task, in MB")
      ->check(CLI::PositiveNumber)
      ->group(sharing);
  app.add_option("--cells", o.host.cells, "cells of the bin-tree, about (default: by the size of the scene)")
      ->check(CLI::Range(1, 1 << 22))
      ->group(sharing);
  app.add_option("--tile", o.host.tileSamples, "samples of a pyramid, at most")
      ->check(CLI::Range(1, 65536))
      ->group(sharing);
  app.add_flag("--dynamic-shading", o.host.dynamicShading, "choose shade tasks by how busy they are")
      ->group(tasks);
  app.add_option("--window", o.host.window, "samples on their way at a time")
      ->check(CLI::Range(1, 1 << 24))
      ->group(tasks);
  app.add_option("--patience", o.patience,
                 "seconds of silence after which a task that renders counts as hanging (default: 30)")
      ->check(CLI::Range(0.1, 1e6))
      ->group(tasks);
  app.add_flag("--plan", o.plan, "render nothing: print which tasks would run where and why")->group(tasks);
  app.add_option("--table", o.tableFile, "write what each task did to this file, as tab-separated values")
      ->group(tasks);
  app.add_flag("--mixed", o.host.mixedArithmetic, "go on when hosts compute different bits")->group(tasks);
}

double megabytes(std::uint64_t bytes) { return 1e-6 * static_cast<double>(bytes); }

void writeTable(std::FILE* to, const HostSummary& s, std::uint64_t pictureSum) {
  std::fprintf(to, "%-21s %-12s %9s %9s %10s %9s %9s %8s %8s %7s %7s %7s %7s %7s %7s\n", "task", "host",
               "objects", "rays", "visits", "hits", "shaded", "msg in", "msg out", "MB in", "MB out",
               "busy s", "idle s", "waiting", "peak MB");
  for (const TaskSummary& task : s.tasks) {
    const Report& r = task.report;
    const TraceCounts& c = r.counts;
    const std::string name =
        std::string(programName(task.placement.role)).substr(9) + " " + std::to_string(task.placement.index);
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

// The hosts that there would be; asks a virtual machine that runs, but changes and starts nothing.
std::vector<HostInfo> plannedHosts(const MachineOptions& options) {
  std::vector<HostLine> lines;
  if (!options.hostFile.empty()) {
    std::ifstream in(options.hostFile);
    if (!in) throw MachineError(options.hostFile + ": the host file cannot be read");
    lines = readHostFile(in);
  }
  std::vector<HostInfo> running;
  if (lookForMachine() == MachineState::alive) {
    const VirtualMachine machine({});
    running = PvmLink().hosts();
  }
  char name[256] = "localhost";
  if (!lines.empty()) gethostname(name, sizeof name - 1);
  return hostsAfterJoining(running, lines, isThisMachine, name);
}

int run(HostProgramOptions& options) {
  // The first pass finds all that is wrong with the scene before anything is started.
  FirstPass pass;
  SceneHead head = parseScene(options.render.parse, pass);
  applyOptions(options.render, head);
  Survey survey = pass.survey.survey();
  if (survey.objects == 0)
    throw SceneError(sceneName(options.render) + ": error: there is nothing to be rendered");
  const View view = *viewOf(head.camera, head.picture);
  const SceneWork work = sceneWork(scenePlan(pass.features.features(), head), survey.objects);
  if (options.plan) {
    const std::vector<HostInfo> hosts = plannedHosts(options.machine);
    applySchedule(options, static_cast<std::uint32_t>(hosts.size()));
    std::fputs(describePlan(hosts, options.host, survey, {view, head.picture}, head.settings, work).c_str(),
               stdout);
    return 0;
  }
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
  // Whatever is to be written, before any task is started.
  std::unique_ptr<PictureWriter> writer = open(first);
  OutputFile table(options.tableFile), report(reportFile(options.render, head));

  VirtualMachine machine(options.machine);
  for (const std::string& host : machine.missingHosts())
    std::fprintf(stderr, "rayshade-host: warning: host %s did not join\n", host.c_str());
  PvmLink link;
  options.host.seed = options.render.seed;
  options.host.killAfter = options.patience;
  options.host.pingAfter = options.patience / 3;
  const std::size_t hosts = link.hosts().size();
  applySchedule(options, static_cast<std::uint32_t>(hosts));
  options.host.wishes = neededTasks(work, options.host, hosts).wishes;
  HostTask host(
      link, [&](SceneSink& sink) { parseScene(again, sink); }, survey, head.settings, options.host);
  const std::int32_t everyRows = rowsBetweenLines(options.render, head);
  Picture sum{area.width, area.height, {}};
  for (std::int32_t frame = first; frame < first + head.picture.frames; ++frame) {
    if (frame != first) writer = open(frame);
    ProgressLine progress(!quiet);
    std::int32_t rows = 0;
    host.renderFrame(
        view, head.picture, frame,
        [&](const std::vector<Color>& row) {
          writer->row(row);
          appendRow(sum, row);
          if (everyRows > 0 && ++rows % everyRows == 0) sayLine(rows, area.height, area.width);
        },
        [&](const HostTask::Completed& p) { progress.show(p.rows, p.allRows, p.samples, "samples"); });
    writer->finish();
    progress.clear();
    const std::uint64_t pictureSum = checksum(sum);
    sum.pixels.clear();
    if (frame == first + head.picture.frames - 1) {
      const HostSummary summary = host.finish();
      if (report) {
        writeTable(report.file(), summary, pictureSum);
      } else if (!quiet || options.render.verbose) {
        writeTable(stderr, summary, pictureSum);
      }
      if (table) std::fputs(taskTable(summary, pictureSum).c_str(), table.file());
      report.close();
      table.close();
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
  options.render.parse.print = [](const std::string& message) {
    std::fprintf(stderr, "%s\n", message.c_str());
  };
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
