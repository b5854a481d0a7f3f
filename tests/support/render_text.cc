// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/render_text.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>

#include "rayshade/space/survey.h"

namespace rayshade {

SceneHead Job::read(SceneSink& sink) const {
  SceneHead head =
      text.empty() ? parseScene(options.parse, sink) : parseSceneText(text, "text", options.parse, sink);
  applyOptions(options, head);
  return head;
}

Job jobOf(const std::string& commandLine) {
  Job job;
  CLI::App app;
  declareOptions(app, job.options);
  app.parse(commandLine, false);
  return job;
}

Job jobOfText(std::string text) {
  Job job;
  job.text = std::move(text);
  return job;
}

Rendered renderSequentially(const Job& job, std::uint32_t voxels, unsigned threads) {
  Scene scene;
  const SceneHead head = job.read(scene.model.store());
  scene.settings = head.settings;
  const View view = viewOf(head.camera, head.picture).value();
  const PixelArea area = pixelArea(head.picture).value();
  Rendered result;
  const std::int32_t first = head.picture.firstFrame;
  for (std::int32_t frame = first; frame < first + head.picture.frames; ++frame) {
    scene.prepare(exposureOf(head.picture, frame), voxels);
    Picture picture{area.width, area.height, {}};
    const FrameResult done = renderFrame(scene, {view, head.picture, job.options.seed}, frame, threads,
                                         [&](const std::vector<Color>& row) { appendRow(picture, row); });
    result.frames.push_back(std::move(picture));
    result.counts = result.counts + done.counts;
    result.notFinite += done.samples.notFinite;
  }
  result.objects = scene.model.store().objectCount();
  return result;
}

RenderedByTasks renderByTasks(const Job& job, const HostOptions& hostOptions,
                              const SimulatedMachine::Options& machineOptions,
                              const std::function<void(SimulatedMachine&)>& prepare,
                              std::vector<EventLane>* lanes) {
  SimulatedMachine machine(machineOptions);
  if (prepare) prepare(machine);
  RenderedByTasks result = renderOn(machine, job, hostOptions, lanes);
  result.moves = machine.moves();
  result.deaths = machine.deaths();
  result.peakQueue = machine.peakQueue();
  return result;
}

RenderedByTasks renderOn(Machine& machine, const Job& job, const HostOptions& hostOptions,
                         std::vector<EventLane>* lanes, const std::function<void(const HostTask&)>& hasHost) {
  SurveySink survey({});
  const SceneHead head = job.read(survey);
  const View view = viewOf(head.camera, head.picture).value();
  const PixelArea area = pixelArea(head.picture).value();
  HostOptions options = hostOptions;
  options.seed = job.options.seed;
  HostTask host(
      machine, [&](SceneSink& sink) { job.read(sink); }, survey.survey(), head.settings, options);
  if (hasHost) hasHost(host);
  if (lanes != nullptr) host.observe(kMostEvents, [lanes](const EventLane& lane) { lanes->push_back(lane); });
  RenderedByTasks result;
  const std::int32_t first = head.picture.firstFrame;
  for (std::int32_t frame = first; frame < first + head.picture.frames; ++frame) {
    Picture picture{area.width, area.height, {}};
    host.renderFrame(view, head.picture, frame,
                     [&](const std::vector<Color>& row) { appendRow(picture, row); });
    result.frames.push_back(std::move(picture));
  }
  result.summary = host.finish();
  for (const TaskSummary& task : result.summary.tasks) result.counts = result.counts + task.report.counts;
  return result;
}

CurrentDirectory::CurrentDirectory(const std::string& directory) : before_(std::filesystem::current_path()) {
  std::filesystem::current_path(directory);
}
CurrentDirectory::~CurrentDirectory() {
  std::error_code ignored;
  std::filesystem::current_path(before_, ignored);
}

std::uint64_t numberFromEnvironment(const char* name, std::uint64_t otherwise) {
  const char* const value = std::getenv(name);
  return value != nullptr && *value != '\0' ? std::strtoull(value, nullptr, 10) : otherwise;
}

}  // namespace rayshade
