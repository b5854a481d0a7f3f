// Texts with mistakes, and files that are not there.
// guarded: reads text of others
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "rayshade/language/preprocessor_messages.h"
#include "tests/support/parsed_text.h"

namespace rayshade {
namespace {

TEST(Parser, ShowsPlaceLineAndCaret) {
  EXPECT_EQ(parse("surface red diffuse 1 0 0\nsphere red 1 0 0 0\n\tbox chrome 0 0 0 1 1 1\n")->errors,
            "s.ray:3:6: error: undefined surface `chrome`\n"
            "  \tbox chrome 0 0 0 1 1 1\n"
            "  \t    ^");
}

TEST(Parser, NamesWhatIsMissing) {
  EXPECT_EQ(errorOf("sphere late 1 0 0 0\nsurface late"), "s.ray:1:8: error: undefined surface `late`");
  EXPECT_EQ(errorOf("object thing"), "s.ray:1:8: error: undefined object `thing`");
  EXPECT_EQ(errorOf("name n object n"), "s.ray:1:15: error: undefined object `n`");
  EXPECT_EQ(errorOf("sphere (radius * 2) 0 0 0"), "s.ray:1:9: error: `radius` is not defined");
  EXPECT_EQ(errorOf("spheres 1 0 0 0"), "s.ray:1:1: error: a statement is expected here, not `spheres`");
  EXPECT_EQ(errorOf("sphere 1 0 0"), "s.ray:1:13: error: a number is expected here, not the end of the text");
  EXPECT_EQ(errorOf("sphere -(3) 0 0 0"), "s.ray:1:9: error: a number is expected here, not `(`");
  EXPECT_EQ(errorOf("surface map"),
            "s.ray:1:9: error: `map` is a reserved word and cannot be the name of a surface");
  EXPECT_EQ(errorOf("sphere 1 0 0 0 texture gravel"),
            "s.ray:1:24: error: a texture is expected here, not `gravel`");
  EXPECT_EQ(errorOf("sphere 1 0 0 0 texture checker scale 2 2 2"),
            "s.ray:1:32: error: a surface is expected here, not `scale`");
  EXPECT_EQ(errorOf("define a 3 define a 4"), "s.ray:1:19: error: `a` is defined already");
  EXPECT_EQ(errorOf("define pi 3"), "s.ray:1:8: error: `pi` is defined already");
}

TEST(Parser, AllowsTimeOnlyInTransformsAndVariables) {
  EXPECT_EQ(errorOf("sphere (time) 0 0 0"),
            "s.ray:1:8: error: this depends on time: only transforms and variables may");
  EXPECT_EQ(errorOf("define t (frame) sphere 1 0 0 0 translate (t) 0 0"), "");
  EXPECT_NE(errorOf("define t (frame) surface a specpow (t)"), "");
}

TEST(Parser, GoesOnAtTheNextStatementAfterAnError) {
  const auto s = parse(
      "spheres 1\nsphere red 1 0 0 0\nsphere 1 0 0 x\nbox 0 0 0 1 1 1\nlist\n sphere grey 1 0 0 0\n box "
      "nix\nend\nsphere blue 1 0 0 0");
  EXPECT_EQ(linesOf(s->errors), (std::vector<int>{1, 2, 3, 6, 7, 9}));
}

TEST(Parser, GoesOnInsideOfAggregatesAfterAnError) {
  const auto s = parse(
      "grid 3 3\n list\n  sphere nix 1 0 0 0\n  name ball sphere 1 0 0 0\n  surface red diffuse 1 0 0\n end\n"
      " union sphere nix 1 0 0 0\n  box 1 2\n end\nend\nobject red ball\nlist\n box 3\nend rotate 1\n"
      "sphere 1\n");
  EXPECT_EQ(linesOf(s->errors), (std::vector<int>{2, 3, 7, 9, 14, 15, 16})) << s->errors;
}

TEST(Parser, SaysOnceThatAnEndIsForgotten) {
  const auto s = parse("list\n sphere 1 0 0 0\nlight 1 point 0 0 0\nscreen 3 3\nsphere nix 1 0 0 0\nfov 3\n");
  EXPECT_EQ(linesOf(s->errors), (std::vector<int>{3, 5})) << s->errors;
}

TEST(Parser, TakesAReservedWordInTheMiddleOfALineForNoStatement) {
  EXPECT_EQ(
      linesOf(
          parse("surface sphere diffuse 1 1 1\nsphere surface 1 0 0 0\nname list sphere 1 0 0 0\n")->errors),
      (std::vector<int>{1, 2, 3}));
}

TEST(Parser, TellsTheSinkNothingBehindAnError) {
  const auto s = parse("sphere 1 0 0 0\nspheres\nsphere 1 0 0 0");
  EXPECT_EQ(s->items.objects.size(), 1u);
  EXPECT_EQ(s->items.settledCount, 1);
}

TEST(Parser, DoesNotComplainOfTheUsesOfABadDefinition) {
  const auto s = parse(
      "surface red diffuse 1 x\nsphere red 1 0 0 0\nname n sphere 1 0\nobject n\ndefine a (b)\nsphere (a) 0 "
      "0 0\n"
      "name m list\n sphere 1\nend\nunion object m sphere 1 0 0 0 end\nname k list object m end object k\n");
  EXPECT_EQ(linesOf(s->errors), (std::vector<int>{1, 4, 5, 9})) << s->errors;
  EXPECT_TRUE(s->warnings.empty()) << s->warnings[0];
}

TEST(Parser, StopsAfterTwentyErrors) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += "sphere nix 1 0 0 0\n";
  const auto s = parse(text);
  EXPECT_NE(s->errors.find("s.ray:20:"), std::string::npos);
  EXPECT_EQ(s->errors.find("s.ray:21:"), std::string::npos);
}

TEST(Parser, StopsAtOnceWhenTheTextIsNoText) {
  const auto s = parse(std::string("x\x9b\xb4\xca\0\0\x7f", 7));
  EXPECT_NE(s->errors.find("s.ray:1:2: error: unexpected byte 0x9b"), std::string::npos);
}

TEST(Parser, SaysThatANumberIsTooLarge) {
  EXPECT_EQ(errorOf("sphere 1 0 0 0\nsphere 1e400 0 0 0"), "s.ray:2:8: error: the number 1e400 is too large");
  EXPECT_EQ(errorOf("screen 1e10 5"),
            "s.ray:1:8: error: a whole number from 1 to 65536 is expected here, not 1e+10");
}

// ---- files and the preprocessor

TEST(Parser, NamesAMissingFile) {
  EXPECT_EQ(parseFile("tests/data/parser/nowhere.ray")->errors,
            "tests/data/parser/nowhere.ray: error: cannot be read: No such file or directory");
  EXPECT_NE(parseFile("tests/data")->errors, "");
}

TEST(Parser, RunsThePreprocessorWhereADirectiveIs) {
  const auto s = parseFile("tests/data/parser/macros.ray", "-DRADIUS=2.5");
  EXPECT_EQ(s->errors, "");
  ASSERT_EQ(s->items.objects.size(), 2u);
  EXPECT_EQ(std::get<Sphere>(std::get<AnyShape>(s->items.objects[1].body)).radius, 2.5);
}

TEST(Parser, NamesTheFileAndLineOfTheSourceNotOfThePreprocessor) {
  const auto s = parseFile("tests/data/parser/macros_and_error.ray");
  EXPECT_EQ(firstLine(s->errors),
            "tests/data/parser/macros_and_error.ray:7:1: error: a statement is expected here, not `spheres`");
  EXPECT_EQ(s->items.objects.size(), 2u);
}

TEST(Parser, RefusesDirectivesWhenItMayNotPreprocess) {
  ParsedText scene;
  ParseOptions options = scene.options();
  options.fileName = "tests/data/parser/macros.ray";
  options.preprocess = false;
  EXPECT_THROW(parseScene(options, scene.items), SceneError);
}

TEST(Parser, EndsWhenAFileIncludesItself) {
  const auto once = parseFile("tests/data/bad/include_self.ray");
  EXPECT_NE(once->errors.find("tests/data/bad/include_self.ray:4:1: error: #include nested"),
            std::string::npos)
      << once->errors;
  EXPECT_NE(parseFile("tests/data/bad/include_self_twice.ray")->errors.find("#include"), std::string::npos);
}

TEST(Parser, BelievesTheExitStatusOfThePreprocessor) {
  const auto s = parseFile("tests/data/bad/include_missing.ray");
  EXPECT_EQ(
      s->errors,
      "tests/data/bad/include_missing.ray:2:11: error: `nowhere.inc` cannot be included: No such file or "
      "directory\n  #include \"nowhere.inc\"\n            ^");
  EXPECT_NE(parseFile("tests/data/bad/open_comment.ray")->errors.find("open_comment.ray:2:1: error: "),
            std::string::npos);
}

// ---- what cpp says

std::vector<std::string> completeOf(const std::string& said) {
  std::vector<std::string> messages;
  for (const PreprocessorMessage& m : preprocessorMessages(said))
    messages.push_back((m.isWarning ? "W " : "E ") + m.complete);
  return messages;
}

TEST(PreprocessorMessages, TakeOurForm) {
  EXPECT_EQ(completeOf("In file included from b.inc:2,\n                 from a.ray:8:\n"
                       "c.inc:3: error: no macro name given in #ifdef directive\n    3 | \t#ifdef\n      | \n"
                       "a.ray:4:2: warning: #warning hmm [-Wcpp]\n    4 | #warning hmm\n      |  ^~~~~~~\n"
                       "a.ray:5: note: here\n"),
            (std::vector<std::string>{
                "E c.inc:3:1: error: no macro name given in #ifdef directive\n  \t#ifdef\n  ^",
                "W a.ray:4:2: warning: #warning hmm\n  #warning hmm\n   ^", "W a.ray:5:1: note: here"}));
  EXPECT_EQ(
      completeOf(
          "nowhere/a.ray:4:2: fatal error: x.inc: No such file or directory\n    4 | sphere\n      |  ^\n"
          "compilation terminated.\n"),
      (std::vector<std::string>{
          "E nowhere/a.ray:4:2: error: `x.inc` cannot be included: No such file or directory"}));
  EXPECT_EQ(completeOf("cpp: error: unrecognized command-line option '-x'\n"),
            (std::vector<std::string>{"E cpp: error: unrecognized command-line option '-x'"}));
  EXPECT_EQ(completeOf("some line that nobody knows\n\n: 3\n").size(), 0u);
}

// ---- many warnings

TEST(Warnings, OfOneKindAreSaidThreeTimesThenCounted) {
  std::string text;
  for (int i = 0; i < 3000; ++i) {
    const std::string y = std::to_string(i);
    text += "triangle 0 " + y + " 0 0 0 -1 1 " + y + " 0 0 0 -1 0 " + std::to_string(i + 1) + " 0 0 0 -1\n";
    if (i % 2 == 0) text += "surface a" + y + " diffuse 1 1 1 surface a" + y + " diffuse 1 1 1\n";
    if (i == 1000) text += "sphere 0 0 0 0\n";
  }
  const auto s = good(text);
  ASSERT_EQ(s->warnings.size(), 3u + 3 + 1 + 2);
  int counted = 0;
  for (const std::string& warning : s->warnings) {
    if (warning.starts_with("... and 2997 more of this kind: the corners run clockwise")) ++counted;
    if (warning.starts_with("... and 1497 more of this kind: surface `a0` is defined again")) ++counted;
    if (!warning.starts_with("... ")) {
      EXPECT_NE(warning.find(": warning: "), std::string::npos) << warning;
    }
  }
  EXPECT_EQ(counted, 2);
}

}  // namespace
}  // namespace rayshade
