// The files of a scene: where they are looked for, and what editors and old systems leave in them.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/parsed_text.h"
#include "tests/support/program.h"
#include "tests/support/scratch_directory.h"

namespace rayshade {
namespace {

class SceneFiles : public testing::Test {
 protected:
  SceneFiles() { std::filesystem::create_directories(scratch_ / "sub"); }
  std::string put(const std::string& file, const std::string& text) const {
    std::ofstream(scratch_ / file, std::ios::binary) << text;
    return scratch_ / file;
  }
  ScratchDirectory scratch_{"scene-files"};
};

const std::string kMark("\xef\xbb\xbf");

TEST_F(SceneFiles, AreFoundBesideTheFileThatNamesThem) {
  put("colors.map", "1 2 3\n");
  put("one.mtv", "1 1\nabc");
  put("hills.hf", readText("tests/support/hills.hf"));
  const auto s = parseFile(put("s.ray",
                               "heightfield hills.hf texture image one.mtv texture marble colors.map\n"
                               "heightfield diffuse 1 1 1 hills.hf\n"));
  EXPECT_EQ(s->errors, "");
  EXPECT_EQ(s->items.objects.size(), 2u);
}

TEST_F(SceneFiles, AreFoundBesideAnIncludedFile) {
  put("sub/hills.hf", readText("tests/support/hills.hf"));
  put("one.mtv", "1 1\nabc");
  put("sub/part.inc", "heightfield hills.hf\n");
  const auto s = parseFile(put("s.ray", "#include \"sub/part.inc\"\nsphere 1 0 0 0 texture image one.mtv\n"));
  EXPECT_EQ(s->errors, "");
  EXPECT_EQ(s->items.objects.size(), 2u);
}

TEST_F(SceneFiles, AreFoundWhereTheProgramRunsFirst) {
  std::filesystem::create_directories(scratch_ / "tests/support");
  put("tests/support/hills.hf", "no height field");
  EXPECT_EQ(parseFile(put("s.ray", "heightfield tests/support/hills.hf"))->errors, "");
  // A directory does not stand in the way.
  put("sub/scenes", "1 2 3\n");
  EXPECT_EQ(parseFile(put("sub/s.ray", "sphere 1 0 0 0 texture marble scenes"))->errors, "");
}

TEST_F(SceneFiles, ThatAreMissingAreNamedWithBothPlaces) {
  const std::string name = put("s.ray", "sphere 1 0 0 0\n  texture image smooth/none.png\n");
  EXPECT_EQ(firstLine(parseFile(name)->errors), name +
                                                    ":2:17: error: smooth/none.png: no such file, neither "
                                                    "where the program runs nor in " +
                                                    scratch_.path());
  EXPECT_EQ(errorOf("sphere 1 0 0 0 texture image /nowhere/none.png"),
            "s.ray:1:30: error: /nowhere/none.png: no such file");
  EXPECT_EQ(errorOf("heightfield none.hf"), "s.ray:1:13: error: none.hf: no such file");
}

TEST_F(SceneFiles, MayBeginWithAByteOrderMarkAndEndWithControlZ) {
  put("part.inc", kMark + "sphere 1 0 0 0\r\n\x1a");
  EXPECT_EQ(parseFile(put("a.ray", kMark + "sphere 1 0 0 0\n\x1a"))->items.objects.size(), 1u);
  const auto s = parseFile(put("b.ray", kMark + "#include \"part.inc\"\nsphere 2 0 0 0\n\x1a\n"));
  EXPECT_EQ(s->errors, "");
  EXPECT_EQ(s->items.objects.size(), 2u);
  const auto wrong = parseFile(put("c.ray", kMark + "spheres"));
  EXPECT_EQ(firstLine(wrong->errors),
            scratch_ / "c.ray" + ":1:1: error: a statement is expected here, not `spheres`");
}

}  // namespace
}  // namespace rayshade
