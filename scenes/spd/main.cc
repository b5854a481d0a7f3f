// Program spd: writes a scene of the Standard Procedural Databases to standard output.
//
//   spd balls 6 > balls6.ray        597 872 spheres
//   spd --help
// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <string>
#include <vector>

#include "rayshade/program/command_line.h"
#include "rayshade/program/option_values.h"
#include "scenes/spd/spd.h"

namespace {

using namespace rayshade;
using namespace rayshade::spd;

std::vector<std::string> namesOfScenes() {
  std::vector<std::string> names;
  for (const SceneKind& kind : sceneKinds()) names.emplace_back(kind.name);
  return names;
}

std::string sizesOfScenes() {
  std::string text;
  for (const SceneKind& kind : sceneKinds())
    text += (text.empty() ? "" : ", ") + std::string(kind.name) + " " + std::to_string(kind.usualSize) +
            " to " + std::to_string(kind.largestSize);
  return text;
}

}  // namespace

int main(int count, char** words) {
  CLI::App app("spd - writes a scene of the Standard Procedural Databases", "spd");
  std::string name, format(WriterOptions{}.format);
  int size = 0;
  WriterOptions wishes;
  app.add_option("name", name, "which scene")->check(CLI::IsMember(namesOfScenes()))->required();
  app.add_option("size", size, "how large; the usual and the largest: " + sizesOfScenes())
      ->check(wholeNumberFrom(1, 1'000'000));
  app.add_option("--format", format, "for which renderer")
      ->check(CLI::IsMember({"rayshade", "pov", "tachyon"}));
  app.add_flag("--grid", wishes.grid,
               "put the objects into a grid, as Rayshade 4 needs it to be fast (format rayshade only)");
  app.footer("Exit status: 0, 1 when standard output cannot be written, 2 for a bad command line.");
  if (const std::optional<int> status = readCommandLine(app, count, words)) return *status;

  std::ios::sync_with_stdio(false);
  wishes.format = format;
  if (!writeScene({name, size}, *makeWriter(wishes, std::cout))) {
    std::cerr << "spd: " << name << " goes up to " << findScene(name)->largestSize << ", not " << size
              << "\n";
    return 2;
  }
  std::cout.flush();
  return std::cout ? 0 : 1;
}
