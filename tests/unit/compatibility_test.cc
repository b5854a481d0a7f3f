// Every file that says where it differs from Rayshade 4 is in docs/compatibility.md, with a scene for each difference that it
// labels.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace {

std::string textOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

const std::string kDocument = "docs/compatibility.md";

TEST(Compatibility, EveryFileThatDiffersIsInTheDocument) {
  const std::string document = textOf(kDocument);
  ASSERT_FALSE(document.empty()) << kDocument << ": run the tests from the top of the repository";
  int files = 0;
  for (const char* root : {"rayshade", "pvm"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
      if (!entry.is_regular_file()) continue;
      const std::string name = entry.path().generic_string();
      if (textOf(entry.path()).find("differs from rayshade4") == std::string::npos) continue;
      ++files;
      EXPECT_NE(document.find('`' + name + '`'), std::string::npos) << name << " is not in " << kDocument;
    }
  }
  EXPECT_GT(files, 15);
}

TEST(Compatibility, EveryDifferenceThatIsMentionedHasAScene) {
  const std::string document = textOf(kDocument);
  const std::size_t scenes = document.find("## Scenes that show the differences");
  ASSERT_NE(scenes, std::string::npos);
  const std::regex label("\\[(D[0-9]+)\\]");
  for (std::sregex_iterator at(document.begin(), document.end(), label), end; at != end; ++at) {
    const std::string text = at->str();
    EXPECT_NE(document.find("\n" + text + " ", scenes), std::string::npos) << text << " has no scene";
    EXPECT_LT(document.find(text), scenes) << text << " is not mentioned in the tables";
  }
}

}  // namespace
