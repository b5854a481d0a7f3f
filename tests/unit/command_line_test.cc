// What the programs say of their command lines, before they do anything.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "tests/support/program.h"
#include "tests/support/scratch_directory.h"

namespace rayshade {
namespace {

namespace fs = std::filesystem;

class CommandLine : public testing::Test {
 protected:
  Finished run(std::vector<std::string> words) {
    words[0] = programDirectory() + "/" + words[0];
    return Program(words, scratch_ / "program").wait(60);
  }
  Finished shell(const std::string& script) {
    return Program({"bash", "-c", script, "bash", programDirectory(), scratch_.path()}, scratch_ / "shell")
        .wait(60);
  }
  // Nothing but one line, which begins with the name of the program and contains `what`.
  void expectRefused(const std::vector<std::string>& words, const std::string& what) {
    const Finished done = run(words);
    std::string line;
    for (const std::string& word : words) line += word + " ";
    EXPECT_EQ(done.status, 2) << line << done.errors;
    EXPECT_EQ(countLines(done.errors), 1u) << line << done.errors;
    EXPECT_TRUE(done.errors.starts_with(words[0] + ": ")) << line << done.errors;
    EXPECT_NE(done.errors.find(what), std::string::npos) << line << done.errors;
    EXPECT_EQ(done.output, "") << line;
  }

  ScratchDirectory scratch_{"command-line"};
};

TEST_F(CommandLine, ValuesThatMakeNoSenseAreRefused) {
  struct Case {
    std::string option, values;  // separated by |
  };
  const std::string numbers = "x||nan|inf|-inf|1e400|-1|1x";
  for (const Case& c : {Case{"-A", numbers + "|1.5|99999999999999999999|2000000"},
                        {"-N", numbers + "|0|1.5|99999999999999999999"},
                        {"-E", numbers},
                        {"-S", numbers + "|0|65|2.5"},
                        {"-D", numbers + "|1.5|99999999999"},
                        {"-F", numbers + "|0|1.5"},
                        {"-G", numbers + "|0"},
                        {"--seed", numbers + "|1.5|18446744073709551616"}}) {
    std::istringstream values(c.values);
    for (std::string value; std::getline(values, value, '|');)
      expectRefused({"rayshade", c.option, value}, c.option);
  }
  for (const std::string number : {"x", "", "nan", "inf", "1e400", "-1"}) {
    expectRefused({"rayshade", "-X", "0", "1", number, "1"}, "-X");
    expectRefused({"rayshade", "-R", "10", number}, "-R");
    expectRefused({"rayshade", "-W", "0", "1", number, "1"}, "-W");
    expectRefused({"rayshade", "-T", "0", number, "0"}, "-T");
    expectRefused({"rayshade", "-C", number, "0", "0"}, "-C");
    for (const std::string option :
         {"--cache", "--patience", "--voxels", "--shades", "--pyramids", "--clusters", "--cells", "--tile",
          "--window", "--voxels-per-task", "--horizon", "--schedule", "--split", "--shading", "--shadows"}) {
      expectRefused({"rayshade-host", option, number}, option);
    }
  }
  for (const std::string option : {"--cache", "--patience", "--voxels"})
    expectRefused({"rayshade-host", option, "0"}, option);
  expectRefused({"rayshade", "-R", "10"}, "-R");
  expectRefused({"rayshade", "one.ray", "two.ray"}, "two.ray");
  expectRefused({"rayshade", "--no-such-option"}, "--no-such-option");
  expectRefused({"rayshade-error", "a.png"}, "picture");
  expectRefused({"spd", "balls", "13"}, "12");
  expectRefused({"spd", "ballons"}, "balls");
  expectRefused({"spd"}, "name");
}

TEST_F(CommandLine, FilesThatCannotBeMeantAreRefused) {
  expectRefused({"rayshade", "-O", "x.jpg", "no-such.ray"}, ".png, .ppm, .pfm");
  expectRefused({"rayshade-host", "-O", "x.jpg", "no-such.ray"}, ".png, .ppm, .pfm");
  expectRefused({"rayshade-error", "a.png", "b.png", "--difference", "x.jpg"}, ".png, .ppm, .pfm");
  expectRefused({"rayshade", "-O", "", "no-such.ray"}, "-O");
  expectRefused({"rayshade", ""}, "empty");
  expectRefused({"rayshade", "-V", "", "no-such.ray"}, "-V");
  expectRefused({"rayshade-host", "--hosts", scratch_.path(), "no-such.ray"}, "directory");
  expectRefused({"rayshade-host", "--hosts", scratch_ / "nothing", "no-such.ray"}, "--hosts");
  expectRefused({"rayshade-host", "--table", "", "no-such.ray"}, "--table");
}

TEST_F(CommandLine, TasksStartedByHandSayWhoStartsThem) {
  for (const std::string program : {"rayshade-voxel-trace", "rayshade-pyramid-trace", "rayshade-shade"})
    expectRefused({program}, "rayshade-host");
}

TEST_F(CommandLine, EveryProgramSaysItsNameAndVersion) {
  for (const std::string program : {"rayshade", "rayshade-host", "rayshade-error", "spd", "rayshade-shade"}) {
    const Finished done = run({program, "--version"});
    EXPECT_EQ(done.status, 0);
    EXPECT_TRUE(done.output.starts_with(program + " 1.")) << done.output;
    EXPECT_EQ(countLines(done.output), 1u) << done.output;
  }
}

// The pseudo-terminal is that of script(1), of util-linux.
TEST_F(CommandLine, NoPictureGoesToATerminal) {
  const Finished done =
      shell("script -qec \"$1/rayshade -R 9 9 scenes/gallery/chess.ray\" /dev/null </dev/null");
  EXPECT_EQ(done.status, 2) << done.output;
  EXPECT_NE(done.output.find("-O FILE.png"), std::string::npos) << done.output;
  EXPECT_EQ(countLines(done.output), 1u) << done.output;
}

TEST_F(CommandLine, ManualPagesNameEveryOption) {
  for (const std::string program : {"rayshade", "rayshade-host", "rayshade-error", "spd"}) {
    const std::string page = readText(programDirectory() + "/share/man/man1/" + program + ".1");
    EXPECT_EQ(page, run({program, "--manual-page"}).output) << program;
    std::istringstream help(run({program, "--help"}).output);
    int options = 0;
    for (std::string line; std::getline(help, line);) {
      if (!line.starts_with("  -")) continue;
      std::string name = line.substr(2, line.find_first_of(" ,", 2) - 2), written;
      for (const char c : name) written += c == '-' ? std::string("\\-") : std::string(1, c);
      EXPECT_NE(page.find("\n.TP\n\\fB" + written), std::string::npos) << program << " " << name;
      ++options;
    }
    EXPECT_GE(options, 3) << program;
  }
  EXPECT_EQ(readText(programDirectory() + "/share/man/man1/rayshade-shade.1"), ".so man1/rayshade-host.1\n");
}

TEST_F(CommandLine, CompletionsAreOptionsFilesAndValues) {
  std::ofstream(scratch_ / "ball.ray");
  std::ofstream(scratch_ / "bad.txt");
  fs::create_directory(scratch_ / "below");
  const auto complete = [this](const std::string& program, const std::string& words) {
    return shell(". $1/share/bash-completion/completions/" + program + "; cd $2; COMP_WORDS=(" + program +
                 " " + words + "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _" +
                 std::string(program == "rayshade" ? "rayshade" : "rayshade_host") + "; echo ${COMPREPLY[*]}")
        .output;
  };
  EXPECT_EQ(complete("rayshade", "b"), "ball.ray below\n");
  EXPECT_EQ(complete("rayshade", "-O ba"), "bad.txt ball.ray\n");
  EXPECT_EQ(complete("rayshade", "--se"), "--seed\n");
  EXPECT_EQ(complete("rayshade", "-A ''"), "\n");
  EXPECT_EQ(complete("rayshade-host", "--schedule d"), "data demand\n");
  EXPECT_EQ(complete("rayshade-host", "--hosts below"), "below\n");
  EXPECT_EQ(complete("rayshade-host", "--pat"), "--patience\n");
}

TEST_F(CommandLine, WhatIsInstalledIsRemovedAgain) {
  const std::string make =
      "env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL make -s BIN=$1 PREFIX=/usr DESTDIR=$2/to ";
  const auto files = [this] {
    std::vector<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(scratch_ / "to"))
      if (!entry.is_directory()) found.push_back(entry.path().lexically_relative(scratch_ / "to"));
    std::sort(found.begin(), found.end());
    return found;
  };
  fs::create_directories(scratch_ / "to/usr/bin");
  std::ofstream(scratch_ / "to/usr/bin/another");
  const auto before = files();
  const Finished installed = shell(make + "install-files");
  EXPECT_EQ(installed.status, 0) << installed.errors;
  const auto there = files();
  EXPECT_EQ(there.size(), 1 + 9 + 9 + 6u);
  for (const char* file : {"usr/bin/rayshade-shade", "usr/share/man/man1/rayshade-voxel-trace.1",
                           "usr/share/bash-completion/completions/rayshade-host"})
    EXPECT_TRUE(std::binary_search(there.begin(), there.end(), file)) << file;
  EXPECT_EQ(shell("$2/to/usr/bin/rayshade --version").status, 0);
  const Finished removed = shell(make + "uninstall");
  EXPECT_EQ(removed.status, 0) << removed.errors;
  EXPECT_EQ(files(), before);
}

}  // namespace
}  // namespace rayshade
