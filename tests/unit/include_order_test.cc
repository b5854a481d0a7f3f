// The arrows between the folders: who may include whom.  The picture is in docs/architecture.md.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace rayshade {
namespace {

struct Include {
  std::string from, to;
  bool system = false;  // <...>
};

std::vector<Include> includesOf(const std::string& directory) {
  std::vector<Include> all;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory)) {
    const std::string extension = entry.path().extension();
    if (extension != ".h" && extension != ".cc") continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with("#include ") || line.size() < 12) continue;
      const std::size_t end = line.find_first_of("\">", 10);
      all.push_back({entry.path().generic_string(), line.substr(10, end - 10), line[9] == '<'});
    }
  }
  return all;
}

// rayshade/accel/bvh.h -> rayshade/space; rayshade/trace/trace.h -> rayshade
std::string folderOf(const std::string& file) { return file.substr(0, file.find_last_of('/')); }

// Floors from the ground up: a folder may include its own files and those of any floor below, and nothing beside it unless
// that is said.  `make docs` copies the picture into docs/architecture.md.
using Floors = std::vector<std::vector<std::string>>;
const Floors& floors() {
  static const Floors all{
      {"rayshade/base"},
      {"rayshade/optics", "rayshade/image", "rayshade/events"},
      {"rayshade/shapes", "rayshade/accel", "rayshade/sampling"},
      {"rayshade/lights", "rayshade/textures", "rayshade/atmosphere"},
      {"rayshade/scene"},
      {"rayshade/language", "rayshade/space"},
      {"rayshade/intersect"},
      {"rayshade/shading"},
      {"rayshade/trace"},
      {"rayshade/program"},
      {"pvm/link"},
      {"pvm/messages"},
      {"pvm/schedule"},
      {"pvm/host", "pvm/trace", "pvm/shade"},
      {"pvm/simulation"},
      {"pvm/program"},
  };
  return all;
}

int floorOf(const std::string& folder) {
  for (std::size_t floor = 0; floor < floors().size(); ++floor)
    for (const std::string& room : floors()[floor])
      if (room == folder) return static_cast<int>(floor);
  return -1;
}

TEST(IncludeOrder, EveryArrowIsInThePicture) {
  std::size_t looked = 0;
  for (const char* root : {"rayshade", "pvm"})
    for (const Include& include : includesOf(root)) {
      if (include.system) continue;
      ++looked;
      const std::string from = folderOf(include.from), to = folderOf(include.to);
      if (from == to) continue;
      ASSERT_GE(floorOf(from), 0) << from << " is not in the picture: add it where it belongs";
      EXPECT_LT(floorOf(to), floorOf(from)) << include.from << " includes " << include.to;
    }
  EXPECT_GT(looked, 200u);
}

TEST(IncludeOrder, IncludesAreNamedFromTheRoot) {
  for (const char* root : {"rayshade", "pvm", "tests"})
    for (const Include& include : includesOf(root)) {
      if (include.system) continue;
      EXPECT_TRUE(std::filesystem::exists(include.to)) << include.from << " includes " << include.to;
    }
}

TEST(IncludeOrder, TexturesKnowOfShapesNothingButTheReaderOfArguments) {
  for (const char* folder : {"rayshade/textures", "rayshade/lights", "rayshade/atmosphere"})
    for (const Include& include : includesOf(folder)) {
      if (folderOf(include.to) != "rayshade/shapes") continue;
      EXPECT_EQ(include.to, "rayshade/shapes/arguments.h") << include.from;
    }
}

TEST(IncludeOrder, PvmItselfIsSeenInOneRoomOnly) {
  for (const char* root : {"rayshade", "pvm"})
    for (const Include& include : includesOf(root)) {
      if (include.to != "pvm3.h") continue;
      EXPECT_TRUE(folderOf(include.from) == "pvm/link" && include.from.ends_with(".cc")) << include.from;
    }
}

TEST(IncludeOrder, TasksDoNotKnowEachOther) {
  auto isTask = [](const std::string& file) {
    return file.ends_with("_task.h") || file.ends_with("_task.cc");
  };
  auto stem = [](const std::string& file) { return file.substr(0, file.find_last_of('.')); };
  for (const Include& include : includesOf("pvm")) {
    if (!isTask(include.from) || folderOf(include.from) == "pvm/simulation") continue;
    EXPECT_FALSE(isTask(include.to) && stem(include.to) != stem(include.from))
        << include.from << " includes " << include.to;
    EXPECT_NE(include.to, "pvm/link/pvm_link.h") << include.from;
  }
}

}  // namespace
}  // namespace rayshade
