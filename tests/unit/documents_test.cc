// The documents keep up with the code: generated parts are those of today, links and names lead to something, and all of
// them together can be read in an afternoon.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/program.h"
#include "tests/support/scratch_directory.h"

namespace rayshade {
namespace {

namespace fs = std::filesystem;

// All documents, from the top of the repository.
std::vector<fs::path> documents() {
  std::vector<fs::path> found{"README.md", "hosts/README.md"};
  for (const auto& entry : fs::recursive_directory_iterator("docs"))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  return found;
}

// Without the blocks between lines of ```, in which nothing is a link or a heading.
std::string proseOf(const fs::path& document) {
  std::istringstream lines(readText(document));
  std::string prose;
  bool inBlock = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```"))
      inBlock = !inBlock;
    else if (!inBlock)
      prose += line + "\n";
  }
  return prose;
}

// What stands behind # in a link to each heading.
std::set<std::string> anchorsOf(const fs::path& document) {
  std::set<std::string> anchors;
  std::istringstream lines(proseOf(document));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("#")) continue;
    std::string anchor;
    for (const char c : line.substr(line.find_first_not_of("# "))) {
      if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_')
        anchor += static_cast<char>(std::tolower(c));
      else if (c == ' ')
        anchor += '-';
    }
    anchors.insert(anchor);
  }
  return anchors;
}

TEST(Documents, GeneratedPartsAreThoseOfTheCode) {
  const ScratchDirectory scratch("documents");
  Program program({"docs/generate", "--check", "--bin", programDirectory()}, scratch / "generate");
  const Finished finished = program.wait(60);
  EXPECT_TRUE(finished.inTime);
  EXPECT_EQ(finished.status, 0) << finished.output << finished.errors;
}

// What architecture.md says of the way of a ray is what the programs call.
TEST(Documents, TheLifeOfARayIsThatOfThePrograms) {
  const ScratchDirectory scratch("documents");
  Program program({"tests/support/life_of_a_ray", programDirectory()}, scratch / "life");
  const Finished finished = program.wait(120);
  EXPECT_TRUE(finished.inTime);
  EXPECT_EQ(finished.status, 0) << finished.output << finished.errors;
}

TEST(Documents, LinksLeadSomewhere) {
  const std::regex link("\\]\\(([^)#:]*)(#[^)]*)?\\)");
  int links = 0;
  for (const fs::path& document : documents()) {
    const std::string prose = proseOf(document);
    for (std::sregex_iterator at(prose.begin(), prose.end(), link), end; at != end; ++at, ++links) {
      const std::string file = (*at)[1], anchor = (*at)[2];
      const fs::path target = file.empty() ? document : document.parent_path() / file;
      EXPECT_TRUE(fs::exists(target)) << document << " links to " << file;
      if (!anchor.empty() && target.extension() == ".md") {
        EXPECT_TRUE(anchorsOf(target).contains(anchor.substr(1)))
            << document << " links to " << file << anchor;
      }
    }
  }
  EXPECT_GT(links, 50);
}

TEST(Documents, NameOnlyFilesThatAreThere) {
  const std::regex path("`((rayshade|pvm|tests|scenes|hosts)/[A-Za-z0-9_/.]*)`|(docs/[A-Za-z0-9_/.-]*[a-z])");
  int paths = 0;
  for (const fs::path& document : documents()) {
    const std::string text = readText(document);
    for (std::sregex_iterator at(text.begin(), text.end(), path), end; at != end; ++at, ++paths) {
      const std::string name = (*at)[1].matched ? (*at)[1].str() : (*at)[3].str();
      EXPECT_TRUE(fs::exists(name)) << document << " names " << name;
    }
  }
  EXPECT_GT(paths, 100);
}

// Decisions are not counted: they are a record, each is read when its question comes up.
TEST(Documents, CanBeReadInAnAfternoon) {
  std::size_t words = 0;
  for (const fs::path& document : documents()) {
    if (document.parent_path() == "docs/decisions") continue;
    std::istringstream text(readText(document));
    for (std::string word; text >> word;) ++words;
  }
  EXPECT_LT(words, 22000u);
  EXPECT_LE(countLines(readText("README.md")), 90u) << "README.md is more than two pages";
}

}  // namespace
}  // namespace rayshade
