// Every scene of the reference suite, rendered over real PVM, has the bits that the sequential program gives it.
//
// Small pictures, so that all of them take seconds; one virtual machine for all, so that its start is waited for once.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "tests/support/private_machine.h"
#include "tests/support/program.h"
#include "tests/support/suite.h"

namespace rayshade {
namespace {

constexpr double kPatience = 120;  // seconds, for a loaded machine or slow sanitizers

// The files of one run by their names, with what is in them.
std::map<std::string, std::string> picturesOf(const std::string& program, const std::string& options,
                                              const SuiteScene& scene, const ScratchDirectory& scratch) {
  const std::string directory = scratch / (scene.name + "-" + program);
  std::filesystem::create_directories(directory);
  // What is said last counts: a window of the scene's own would lie outside of so small a screen.
  std::vector<std::string> arguments =
      wordsOf(programDirectory() + "/" + program + " -q " + options + " " + scene.options + " " + scene.name +
              ".ray -R 64 48 -W 0 63 0 47");
  arguments.insert(arguments.end(), {"-O", directory + "/a.pfm"});
  const Finished done = Program(arguments, scratch / program, {}, kSuiteDirectory).wait(kPatience);
  EXPECT_EQ(done.status, 0) << program << ": " << done.errors;
  std::map<std::string, std::string> pictures;
  for (const auto& entry : std::filesystem::directory_iterator(directory))
    pictures[entry.path().filename()] = readText(entry.path());
  return pictures;
}

TEST(PvmSuite, EveryPictureHasTheBitsOfTheSequentialProgram) {
  if (!PrivateMachine::possible()) GTEST_SKIP() << PrivateMachine::kImpossible;
  PrivateMachine machine;
  machine.start();
  ScratchDirectory scratch("pvm-suite");
  const char* const schedules[] = {"--schedule data", "--schedule hybrid --pyramids 1"};
  std::size_t number = 0;
  for (const SuiteScene& scene : suiteScenes()) {
    const std::string schedule = schedules[number++ % 2];
    SCOPED_TRACE(scene.name + " " + schedule);
    const auto expected = picturesOf("rayshade", "", scene, scratch);
    EXPECT_EQ(expected.size(), static_cast<std::size_t>(scene.frames));
    EXPECT_TRUE(picturesOf("rayshade-host", "--voxels 3 --shades 1 " + schedule, scene, scratch) == expected)
        << "the pictures differ";
  }
  EXPECT_GE(number, 50u);
}

}  // namespace
}  // namespace rayshade
