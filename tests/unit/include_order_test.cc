// The arrows between the folders: who may include whom.  The picture is in docs/architecture.md.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
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

// rayshade/space/bvh.h -> rayshade/space; rayshade/trace.h -> rayshade
std::string folderOf(const std::string& file) { return file.substr(0, file.find_last_of('/')); }

const std::map<std::string, std::set<std::string>>& mayInclude() {
  static const std::set<std::string> base{"rayshade/base"};
  static const std::set<std::string> matter{"rayshade/base", "rayshade/optics"};
  static const std::set<std::string> scene{"rayshade/base",     "rayshade/optics", "rayshade/shapes",
                                           "rayshade/textures", "rayshade/lights", "rayshade/atmosphere",
                                           "rayshade/image"};
  auto with = [](std::set<std::string> folders, std::initializer_list<const char*> more) {
    folders.insert(more.begin(), more.end());
    return folders;
  };
  static const std::map<std::string, std::set<std::string>> arrows{
      {"rayshade/base", {}},
      {"rayshade/optics", base},
      {"rayshade/image", base},
      {"rayshade/shapes", matter},
      {"rayshade/lights", with(matter, {"rayshade/shapes"})},  // Arguments, the reader of both, is in shapes
      {"rayshade/textures", with(matter, {"rayshade/shapes", "rayshade/image"})},
      {"rayshade/atmosphere", with(matter, {"rayshade/shapes"})},
      {"rayshade/scene", scene},
      {"rayshade/space", with(scene, {"rayshade/scene"})},
      {"rayshade/shading", with(scene, {"rayshade/scene", "rayshade/space"})},
      {"rayshade", with(scene, {"rayshade/scene", "rayshade/space", "rayshade/shading"})},
      {"pvm", with(scene, {"rayshade/scene", "rayshade/space", "rayshade/shading", "rayshade"})},
  };
  return arrows;
}

TEST(IncludeOrder, EveryArrowIsInThePicture) {
  std::size_t looked = 0;
  for (const char* root : {"rayshade", "pvm"})
    for (const Include& include : includesOf(root)) {
      if (include.system) continue;
      ++looked;
      const std::string from = folderOf(include.from), to = folderOf(include.to);
      const auto arrows = mayInclude().find(from);
      ASSERT_NE(arrows, mayInclude().end()) << from << " is not in the picture: add it where it belongs";
      EXPECT_TRUE(from == to || arrows->second.contains(to)) << include.from << " includes " << include.to;
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

TEST(IncludeOrder, PvmItselfIsSeenBehindTwoDoorsOnly) {
  for (const char* root : {"rayshade", "pvm"})
    for (const Include& include : includesOf(root)) {
      if (include.to != "pvm3.h") continue;
      EXPECT_TRUE(include.from == "pvm/pvm_link.cc" || include.from == "pvm/virtual_machine.cc")
          << include.from;
    }
}

TEST(IncludeOrder, TasksDoNotKnowEachOther) {
  auto isTask = [](const std::string& file) {
    return file.ends_with("_task.h") || file.ends_with("_task.cc");
  };
  auto stem = [](const std::string& file) { return file.substr(0, file.find_last_of('.')); };
  for (const Include& include : includesOf("pvm")) {
    if (!isTask(include.from)) continue;
    EXPECT_FALSE(isTask(include.to) && stem(include.to) != stem(include.from))
        << include.from << " includes " << include.to;
    EXPECT_NE(include.to, "pvm/pvm_link.h") << include.from;
  }
}

}  // namespace
}  // namespace rayshade
