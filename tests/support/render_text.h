// One picture, rendered in two ways: by the sequential renderer and by all tasks in one process.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pvm/host/host_task.h"
#include "pvm/simulation/simulated_machine.h"
#include "rayshade/program/options.h"
#include "rayshade/trace/render.h"

namespace rayshade {

// A scene with the options of the command line that concern the picture; all passes over it read the same.
struct Job {
  Options options;  // options.parse.fileName: the scene, unless there is a text
  std::string text;

  SceneHead read(SceneSink& sink) const;
};

// "-R 40 30 scene.ray", as one writes it to the program.
Job jobOf(const std::string& commandLine);
// Of a text: no preprocessor, no options.
Job jobOfText(std::string text);

struct Rendered {
  std::vector<Picture> frames;
  TraceCounts counts;
  std::uint64_t notFinite = 0;
  std::size_t objects = 0;
};
// `voxels`: into how many space is cut, without effect on the picture, as `threads`.
Rendered renderSequentially(const Job& job, std::uint32_t voxels = 1, unsigned threads = 1);

struct RenderedByTasks {
  std::vector<Picture> frames;
  HostSummary summary;
  TraceCounts counts;  // of all tasks together
  std::uint64_t moves = 0;
  int deaths = 0;
  std::size_t peakQueue = 0;
};
// `prepare` may watch the machine, or aim at its tasks.  With `lanes` events are noted.
RenderedByTasks renderByTasks(const Job& job, const HostOptions& host,
                              const SimulatedMachine::Options& machine,
                              const std::function<void(SimulatedMachine&)>& prepare = {},
                              std::vector<EventLane>* lanes = nullptr);
// The same on any machine, which learns of the host task.
RenderedByTasks renderOn(Machine& machine, const Job& job, const HostOptions& host,
                         std::vector<EventLane>* lanes = nullptr,
                         const std::function<void(const HostTask&)>& hasHost = {});

// While it lives, another directory is the current one: scenes name their files relative to it.
class CurrentDirectory {
 public:
  explicit CurrentDirectory(const std::string& directory);
  CurrentDirectory(const CurrentDirectory&) = delete;
  CurrentDirectory& operator=(const CurrentDirectory&) = delete;
  ~CurrentDirectory();

 private:
  std::string before_;
};

// The number in an environment variable, or `otherwise`.
std::uint64_t numberFromEnvironment(const char* name, std::uint64_t otherwise);

}  // namespace rayshade
