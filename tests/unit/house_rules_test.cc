// What keeps the house easy to walk through: short files, few of them in the top folders, tests named in one style.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace rayshade {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> filesIn(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  return files;
}

std::vector<std::string> linesOf(const fs::path& file) {
  std::vector<std::string> lines;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// By its name, or a script by its first line.
bool isSource(const fs::path& file) {
  const std::string extension = file.extension();
  if (extension == ".cc" || extension == ".h" || extension == ".py") return true;
  std::string first;
  std::ifstream in(file);
  return extension.empty() && std::getline(in, first) && first.starts_with("#!");
}

TEST(HouseRules, NoSourceIsLongerThanFourHundredAndTwentyLines) {
  std::size_t looked = 0;
  for (const char* root : {"rayshade", "pvm", "scenes/spd", "tests"})
    for (const fs::path& file : filesIn(root)) {
      if (!isSource(file)) continue;
      ++looked;
      EXPECT_LE(linesOf(file).size(), 420u) << file;
    }
  EXPECT_GT(looked, 300u);
}

TEST(HouseRules, FilesStandInRooms) {
  for (const char* root : {"rayshade", "pvm"}) {
    const auto direct = std::count_if(fs::directory_iterator(root), fs::directory_iterator(),
                                      [](const auto& entry) { return entry.is_regular_file(); });
    EXPECT_LE(direct, 4) << root;
  }
}

// TEST(TheThing, DoesOrIsSo): both in CamelCase; a fixture is named like the thing, too.
TEST(HouseRules, TestsAreNamedInOneStyle) {
  std::size_t looked = 0;
  for (const fs::path& file : filesIn("tests")) {
    if (file.extension() != ".cc") continue;
    for (const std::string& line : linesOf(file)) {
      if (!line.starts_with("TEST") && !line.starts_with("TYPED_TEST(")) continue;
      const std::size_t open = line.find('('), comma = line.find(", "), close = line.find(')');
      if (open == std::string::npos || comma > close) continue;
      ++looked;
      for (const std::string& name :
           {line.substr(open + 1, comma - open - 1), line.substr(comma + 2, close - comma - 2)}) {
        EXPECT_TRUE(name[0] >= 'A' && name[0] <= 'Z') << file << ": " << name;
        EXPECT_EQ(name.find('_'), std::string::npos) << file << ": " << name;
        EXPECT_FALSE(name.ends_with("Test")) << file << ": " << name;
      }
    }
  }
  EXPECT_GT(looked, 600u);
}

// The Makefile links those that say so into the program that runs under sanitizers.
TEST(HouseRules, SomeTestsAreGuarded) {
  std::size_t guarded = 0;
  for (const fs::path& file : filesIn("tests")) {
    const std::vector<std::string> lines = linesOf(file);
    const auto head = std::find_if(lines.begin(), lines.end(),
                                   [](const std::string& line) { return !line.starts_with("//"); });
    const auto says = [](const std::string& line) { return line.starts_with("// guarded: "); };
    if (std::any_of(lines.begin(), head, says)) ++guarded;
    EXPECT_FALSE(file.extension() == ".cc" && std::any_of(head, lines.end(), says))
        << file << ": say it in the head";
  }
  EXPECT_GE(guarded, 15u);
}

}  // namespace
}  // namespace rayshade
