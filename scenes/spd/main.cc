// Program spd: writes a scene of the Standard Procedural Databases to standard output.
//
//   spd balls 6 > balls6.ray        597 872 spheres
//   spd --help
// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scenes/spd/spd.h"

namespace {

using namespace rayshade::spd;

void explain(std::ostream& out) {
  out << "usage: spd NAME [SIZE] [--format rayshade|pov|tachyon] [--grid]\n\n"
         "  --grid   put the objects into a grid, as Rayshade 4 needs it to be fast (format rayshade "
         "only)\n\n"
         "NAME      usual and largest SIZE\n";
  for (const SceneKind& kind : sceneKinds()) {
    out << kind.name << std::string(10 - kind.name.size(), ' ') << kind.usualSize << ' ' << kind.largestSize
        << '\n';
  }
}

struct CommandLine {
  SceneRequest scene;
  WriterOptions writer;
};

std::optional<int> wholeNumber(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 1) return std::nullopt;
  return value;
}

std::optional<CommandLine> understand(std::span<char* const> words) {
  CommandLine line;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string_view word = words[i];
    if (word == "--grid") {
      line.writer.grid = true;
    } else if (word == "--format" && i + 1 < words.size()) {
      line.writer.format = words[++i];
    } else if (line.scene.name.empty() && findScene(word)) {
      line.scene.name = word;
    } else if (const auto size = wholeNumber(word);
               size && !line.scene.name.empty() && line.scene.size == 0) {
      line.scene.size = *size;
    } else {
      return std::nullopt;
    }
  }
  if (line.scene.name.empty()) return std::nullopt;
  return line;
}

}  // namespace

int main(int count, char** words) {
  if (count == 2 && std::string_view(words[1]) == "--help") {
    explain(std::cout);
    return 0;
  }
  std::ios::sync_with_stdio(false);
  const auto line = understand({words + 1, words + count});
  const auto writer = line ? makeWriter(line->writer, std::cout) : nullptr;
  if (!writer || !writeScene(line->scene, *writer)) {
    explain(std::cerr);
    return 2;
  }
  std::cout.flush();
  return std::cout ? 0 : 1;
}
