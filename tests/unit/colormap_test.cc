// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/textures/colormap.h"

#include <gtest/gtest.h>

#include <limits>

#include "rayshade/base/archive.h"
#include "tests/support/text_arguments.h"

namespace rayshade {
namespace {

Colormap mapOf(std::string_view text) {
  auto map = decodeColormap(text, "colors.map");
  EXPECT_TRUE(std::holds_alternative<Colormap>(map)) << text;
  return std::get<Colormap>(map);
}

std::string problemOf(std::string_view text) {
  const auto map = decodeColormap(text, "colors.map");
  return std::holds_alternative<FileProblem>(map) ? std::get<FileProblem>(map).message : "";
}

TEST(Colormap, LinesAreSharesOf255) {
  const Colormap map = mapOf("255 0 51\n 102\t204 255 \r\n");
  EXPECT_EQ(map.at(0), (Color{1, 0, 0.2}));
  EXPECT_EQ(map.at(1), (Color{0.4, 0.8, 1}));
}

TEST(Colormap, MissingEntriesAreBlack) {
  EXPECT_EQ(mapOf("255 255 255").at(1), kBlack);
  EXPECT_EQ(mapOf("").at(0), kBlack);
}

TEST(Colormap, EntriesAreCutToWholeNumbersAndToTheEnds) {
  std::string text;
  for (int i = 0; i < 256; ++i) text += std::to_string(i) + " 0 0\n";
  const Colormap map = mapOf(text + "1 2 3\nnot looked at\n");
  EXPECT_EQ(map.at(254.999).r, 254 / 255.0);
  EXPECT_EQ(map.at(-3).r, 0);
  EXPECT_EQ(map.at(1e300).r, 1);
  EXPECT_EQ(map.at(std::numeric_limits<double>::quiet_NaN()).r, 0);
}

TEST(Colormap, BadLinesAreNamedByFileAndLine) {
  for (const char* line :
       {"1 2", "1 2 x", "1 2 3 4", "256 0 0", "-1 0 0", "1.5 0 0", "red", "1 2 99999999999"})
    EXPECT_EQ(problemOf(std::string("1 2 3\n\n") + line + "\n"),
              "colors.map:3: not three whole numbers from 0 to 255")
        << line;
}

TEST(Colormap, OfAMissingFileNamesIt) {
  TextArguments in("/nowhere/colors.map");
  try {
    parseColormap(in);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "/nowhere/colors.map: no such file");
  }
}

TEST(Colormap, OfADirectoryIsRefused) {
  TextArguments in("/");
  EXPECT_THROW(parseColormap(in), std::runtime_error);
}

TEST(Colormap, SurvivesTheWireUnchanged) {
  const Bytes bytes = encode(mapOf("1 2 3\n4 5 6\n"));
  const auto back = decode<Colormap>(bytes);
  ASSERT_TRUE(back);
  EXPECT_EQ(encode(*back), bytes);
}

}  // namespace
}  // namespace rayshade
