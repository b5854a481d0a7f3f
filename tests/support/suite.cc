// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/suite.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace rayshade {
namespace {

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (char c : text) {
    if (c == at) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::string said(const std::string& field) { return field == "-" ? "" : field; }

// The lines of a table without comments and its head, each with at least `columns` columns.
std::vector<std::vector<std::string>> readTable(const std::string& file, std::size_t columns) {
  std::vector<std::vector<std::string>> rows;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#' || line.starts_with("name\t")) continue;
    rows.push_back(split(line, '\t'));
    rows.back().resize(std::max(rows.back().size(), columns));
  }
  return rows;
}

}  // namespace

std::vector<SuiteScene> suiteScenes() {
  std::vector<SuiteScene> scenes;
  for (const auto& row : readTable(std::string(kSuiteDirectory) + "/INDEX.tsv", 9)) {
    SuiteScene scene;
    scene.name = row[0];
    scene.options = said(row[2]);
    const std::size_t output = scene.options.find("-O OUT");
    if (output != std::string::npos) scene.options.erase(output, 6);
    scene.exact = row[3] == "exact";
    scene.rmse = std::atof(row[4].c_str());
    scene.rmse4 = std::atof(row[7].c_str());
    scene.frames = std::atoi(row[8].c_str());
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

std::vector<std::string> wordsOf(const std::string& line) {
  std::vector<std::string> list;
  std::string word;
  bool quoted = false, some = false;
  for (char c : line + " ") {
    if (c == '\'') {
      quoted = !quoted;
      some = true;
    } else if (c == ' ' && !quoted) {
      if (some) list.push_back(word);
      word.clear();
      some = false;
    } else {
      word += c;
      some = true;
    }
  }
  return list;
}

std::vector<BadScene> badScenes() {
  std::vector<BadScene> scenes;
  for (const auto& row : readTable(std::string(kSuiteDirectory) + "/bad/expected.tsv", 5))
    scenes.push_back({row[0], said(row[1]), row[2], said(row[3]), split(said(row[4]), '|')});
  return scenes;
}

}  // namespace rayshade
