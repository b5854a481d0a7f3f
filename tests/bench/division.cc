// How well a model is divided: objects that voxel-trace tasks hold, against an equal share.
//
//   bin/bench/division [--split balanced|equal|cost] SCENE...      goals: fullest and together at most 1.30
//
// For 4, 16 and 64 tasks: the fullest task and all tasks together, in objects and in bytes of memory, relative to a division in
// which every object is held once and all tasks hold as much.  The objects are counted one by one with the tree that the host
// would use; nothing is rendered.
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <cstring>
#include <numeric>

#include "pvm/schedule/division.h"
#include "rayshade/language/parser.h"

namespace rayshade {
namespace {

constexpr double kGoal = 1.3;
constexpr std::uint32_t kTasks[] = {4, 16, 64};

struct Held {
  std::vector<double> objects, bytes;  // by task
};

void print(const char* what, const std::vector<double>& held, double once) {
  const double fullest = *std::max_element(held.begin(), held.end());
  const double all = std::accumulate(held.begin(), held.end(), 0.0);
  const double share = once / static_cast<double>(held.size());
  std::printf("  %s %5.2f %5.2f%s", what, fullest / share, all / once,
              fullest / share <= kGoal && all / once <= kGoal ? "" : " !");
}

void measure(const std::string& scene, const HostOptions& options) {
  SurveySink sink({});
  ParseOptions parse;
  parse.fileName = scene;
  const SceneHead head = parseScene(parse, sink);
  Survey survey = sink.survey();
  const View view = *viewOf(head.camera, head.picture);
  for (const std::uint32_t tasks : kTasks) {
    const Division division =
        divideSpace(survey, {view, head.picture}, head.settings, options, std::vector<TaskPlace>(tasks));
    Held held{std::vector<double>(tasks), std::vector<double>(tasks)};
    double objects = 0, bytes = 0;
    ObjectStream stream({}, [&](const SceneObject&, const Bounds& bounds, std::span<const NodeItem* const>,
                                const ObjectStream::Brought& brought) {
      std::vector<VoxelId> voxels;
      voxelsTouching(division.tree, bounds, voxels);
      ++objects;
      const auto size = static_cast<double>(brought.bytes + brought.definition);
      bytes += size;
      for (const VoxelId voxel : voxels) {
        held.objects[division.owners[number(voxel)]] += 1;
        held.bytes[division.owners[number(voxel)]] += size;
      }
    });
    ParseOptions again = parse;
    again.warn = nullptr;
    parseScene(again, stream);
    std::printf("%-24s %8.0f %3u", scene.substr(scene.find_last_of('/') + 1).c_str(), objects, tasks);
    print("objects", held.objects, objects);
    print("bytes", held.bytes, bytes);
    std::printf("\n");
  }
}

}  // namespace
}  // namespace rayshade

int main(int argc, char** argv) {
  using namespace rayshade;
  HostOptions options;
  std::printf("scene, objects, tasks; fullest task and all together, in equal shares; ! above %.2f\n", kGoal);
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--split" && i + 1 < argc) {
      const std::string how = argv[++i];
      options.split = how == "equal" ? Split::equal : how == "cost" ? Split::cost : Split::balanced;
    } else {
      measure(word, options);
    }
  }
}
