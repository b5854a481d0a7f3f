// The reference suite: the program against pictures of the original, and what must happen to scenes that are wrong.
//
// Runs bin/rayshade (RAYSHADE_BIN: the directory of the programs) in the directory of the suite, as one does by hand.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

#include "rayshade/image/picture_file.h"
#include "tests/support/compare_pictures.h"
#include "tests/support/program.h"
#include "tests/support/suite.h"

namespace rayshade {
namespace {

constexpr double kPatience = 100;             // seconds; ten suffice without sanitizers
constexpr double kMostDifferent = 0.005;      // share of the pixels
constexpr long kMostKilobytes = 1024 * 1024;  // of memory

Finished render(const std::string& options, const std::string& scene, const std::string& picture,
                const std::string& directory, const ScratchDirectory& scratch) {
  std::vector<std::string> arguments{programDirectory() + "/rayshade", scene};
  for (const std::string& word : wordsOf(options)) arguments.push_back(word);
  if (!picture.empty()) arguments.insert(arguments.end(), {"-O", picture});
  return Program(arguments, scratch / "program", {}, directory).wait(kPatience);
}

// NAME.png, NAME.f1.png, ... and what the program calls them: NAME.0000.png, ...; frames begin with -A's number.
std::string expectedFrame(const std::string& name, int frame) {
  return std::string(kSuiteDirectory) + "/" + name + (frame == 0 ? "" : ".f" + std::to_string(frame)) +
         ".png";
}
std::vector<std::string> picturesIn(const std::string& directory) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(directory))
    files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Suite, PicturesAreThoseOfTheOriginal) {
  int number = 0;
  for (const SuiteScene& scene : suiteScenes()) {
    SCOPED_TRACE(scene.name + " " + scene.options);
    ++number;
    ScratchDirectory scratch("suite");
    std::filesystem::create_directories(scratch / "pictures");
    const Finished done =
        render(scene.options, scene.name + ".ray", scratch / "pictures/a.png", kSuiteDirectory, scratch);
    ASSERT_EQ(done.status, 0) << done.errors;
    const std::vector<std::string> files = picturesIn(scratch / "pictures");
    ASSERT_EQ(files.size(), static_cast<std::size_t>(scene.frames));
    for (int frame = 0; frame < scene.frames; ++frame) {
      const Picture got = readPicture(files[static_cast<std::size_t>(frame)]);
      const Distance far = distance(got, readPicture(expectedFrame(scene.name, frame)));
      ASSERT_TRUE(far.sameSize);
      if (scene.exact) {
        EXPECT_LE(far.over1, kMostDifferent) << "frame " << frame;
      } else {
        EXPECT_LE(far.rmse, scene.rmse);
        EXPECT_LE(far.rmse4, scene.rmse4);
      }
    }
    const std::string print = readText(std::string(kSuiteDirectory) + "/" + scene.name + ".print");
    if (!print.empty()) {
      EXPECT_NE(done.errors.find(print), std::string::npos) << done.errors;
    }
  }
  EXPECT_GE(number, 50);
}

// ---- what is wrong

// The line numbers of SCENE in messages `SCENE:LINE` or `SCENE, line LINE`.
std::set<int> linesSaid(const std::string& messages, const std::string& scene) {
  std::set<int> lines;
  for (std::size_t at = messages.find(scene); at != std::string::npos; at = messages.find(scene, at + 1)) {
    std::size_t number = at + scene.size();
    for (const char* between : {":", ", line "})
      if (messages.compare(number, std::string(between).size(), between) == 0)
        number += std::string(between).size();
    if (number < messages.size() && std::isdigit(static_cast<unsigned char>(messages[number])) != 0)
      lines.insert(std::stoi(messages.substr(number, 9)));
  }
  return lines;
}

// `wanted`: see BadScene.
bool saysWhere(const std::string& messages, const std::string& scene, const std::string& wanted) {
  if (wanted.empty()) return true;
  const std::set<int> said = linesSaid(messages, scene);
  std::istringstream parts(wanted);
  for (std::string part; std::getline(parts, part, ';');) {
    const std::size_t dash = part.find('-');
    const int low = std::stoi(part);
    const int high = dash == std::string::npos ? low
                     : dash + 1 == part.size() ? 1 << 30
                                               : std::stoi(part.substr(dash + 1));
    if (std::none_of(said.begin(), said.end(), [&](int line) { return line >= low && line <= high; }))
      return false;
  }
  return true;
}

bool saysOneOf(std::string messages, const std::vector<std::string>& words) {
  for (char& c : messages) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return messages.find(word) != std::string::npos; });
}

TEST(Suite, WrongScenesAreRefusedOrWarnedOfAtTheRightLine) {
  const std::string directory = std::string(kSuiteDirectory) + "/bad";
  int number = 0;
  for (const BadScene& bad : badScenes()) {
    SCOPED_TRACE(bad.name);
    ++number;
    ScratchDirectory scratch("bad");
    std::filesystem::create_directories(scratch / "pictures");
    const std::string scene = bad.name + ".ray";
    const Finished done = render(bad.options, scene, scratch / "pictures/a.png", directory, scratch);
    EXPECT_TRUE(done.inTime);
    ASSERT_LT(done.status, 3) << "a crash?\n" << done.errors;
    EXPECT_LT(done.peakKilobytes, kMostKilobytes);
    const bool rendered = done.status == 0;
    if (bad.expect == "error") {
      EXPECT_NE(done.status, 0);
    }
    if (bad.expect == "warn") {
      EXPECT_EQ(done.status, 0) << done.errors;
    }
    const std::vector<std::string> files = picturesIn(scratch / "pictures");
    EXPECT_EQ(files.size(), rendered ? 1u : 0u) << "a picture if it ends well, else none";
    if (!(rendered && bad.expect == "clean")) {
      EXPECT_TRUE(saysWhere(done.errors, scene, bad.lines)) << "line " << bad.lines << " is not named:\n"
                                                            << done.errors;
      EXPECT_TRUE(saysOneOf(done.errors, bad.words)) << done.errors;
    }
    if (rendered && std::filesystem::exists(directory + "/" + bad.name + ".png")) {
      const Distance far =
          distance(readPicture(files.at(0)), readPicture(directory + "/" + bad.name + ".png"));
      EXPECT_TRUE(far.sameSize && far.over1 <= kMostDifferent);
    }
  }
  EXPECT_GE(number, 20);
}

}  // namespace
}  // namespace rayshade
