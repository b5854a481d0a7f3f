// The scenes of the reference suite: what the original program makes of them is in tests/data/suite.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace rayshade {

inline constexpr const char* kSuiteDirectory = "tests/data/suite";

// A line of INDEX.tsv.
struct SuiteScene {
  std::string name;
  std::string options;         // of the command line; without an output file
  bool exact = false;          // the original's picture is a function of the scene, not of its random numbers
  double rmse = 0, rmse4 = 0;  // most, of 255; when not exact
  int frames = 1;
};
std::vector<SuiteScene> suiteScenes();

// Words of a command line; '...' holds one together.
std::vector<std::string> wordsOf(const std::string& line);

// A line of bad/expected.tsv.
struct BadScene {
  std::string name;
  std::string options;
  std::string expect;  // error, warn, warn-or-error, clean
  std::string lines;   // 8-9: any of these; 8;9: each; 5-: from there on; empty: none needed
  std::vector<std::string> words;
};
std::vector<BadScene> badScenes();

}  // namespace rayshade
