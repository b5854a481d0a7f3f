// guarded: reads text of others
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/tokens.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace rayshade {
namespace {

// Tokens of a text that comes in pieces of `piece` bytes.
class TextTokens {
 public:
  explicit TextTokens(std::string text, std::size_t piece = 1 << 20)
      : text_(std::move(text)),
        piece_(piece),
        tokens(
            [this](char* to, std::size_t most) {
              const std::size_t count = text_.copy(to, std::min(most, piece_), at_);
              at_ += count;
              return count;
            },
            "scene.ray") {}

  // All tokens, each as it is written, separated by blanks.
  std::string all() {
    std::string joined;
    for (tokens.advance(); tokens.current().kind != Token::Kind::end; tokens.advance())
      joined += (joined.empty() ? "" : " ") + std::string(tokens.text());
    return joined;
  }

 private:
  std::string text_;
  std::size_t piece_, at_ = 0;

 public:
  Tokens tokens;
};

std::string split(const std::string& text) { return TextTokens(text).all(); }

Fault faultOf(const std::string& text) {
  try {
    TextTokens(text).all();
  } catch (const Fault& fault) {
    return fault;
  }
  return {"no fault", {}};
}

double numberIn(const std::string& text) {
  TextTokens t(text);
  t.tokens.advance();
  EXPECT_EQ(t.tokens.current().kind, Token::Kind::number) << text;
  EXPECT_EQ(t.tokens.text(), text);
  return t.tokens.current().value;
}

TEST(Tokens, ReadEveryFormOfANumber) {
  EXPECT_EQ(numberIn("12"), 12);
  EXPECT_EQ(numberIn("1.5"), 1.5);
  EXPECT_EQ(numberIn("1."), 1);
  EXPECT_EQ(numberIn(".25"), 0.25);
  EXPECT_EQ(numberIn(".5e1"), 5);
  EXPECT_EQ(numberIn("1e-3"), 1e-3);
  EXPECT_EQ(numberIn("2E+3"), 2e3);
  EXPECT_EQ(numberIn("4e2"), 400);
  EXPECT_EQ(numberIn("0.1"), 0.1);
  EXPECT_EQ(numberIn("123456789012345678901234567890"), 123456789012345678901234567890.0);
}

TEST(Tokens, TakeATinyNumberAsZeroAndRefuseAHugeOne) {
  EXPECT_EQ(numberIn("1e-400"), 0);
  const Fault fault = faultOf("a\n  1e400");
  EXPECT_EQ(fault.message, "the number 1e400 is too large");
  EXPECT_EQ(fault.place.line, 2u);
  EXPECT_EQ(fault.place.offset - fault.place.lineStart, 2u);
}

TEST(Tokens, NeedNoBlankBetweenSignsAndNumbers) { EXPECT_EQ(split("1-2+3-.5"), "1 - 2 + 3 - .5"); }

TEST(Tokens, TakeTheLongestName) {
  EXPECT_EQ(split("(length-1) a.b_c-d2 spheres"), "( length-1 ) a.b_c-d2 spheres");
  TextTokens t("spheres sphere");
  t.tokens.advance();
  EXPECT_EQ(t.tokens.current().keyword.word, Word::none);
  t.tokens.advance();
  EXPECT_EQ(t.tokens.current().keyword.word, Word::shape);
}

TEST(Tokens, KnowSynonyms) {
  EXPECT_EQ(findKeyword("resolution").word, Word::screen);
  EXPECT_EQ(findKeyword("reflective").word, findKeyword("reflect").word);
  EXPECT_EQ(findKeyword("translu").word, findKeyword("translucency").word);
  EXPECT_EQ(findKeyword("transp").word, findKeyword("transparent").word);
  EXPECT_EQ(findKeyword("poly").word, findKeyword("polygon").word);
  EXPECT_EQ(findKeyword("poly").index, findKeyword("polygon").index);
  EXPECT_EQ(findKeyword("Sphere").word, Word::none);
  EXPECT_EQ(findKeyword("samples").word, Word::none);
}

TEST(Tokens, SkipCommentsThatDoNotNest) {
  EXPECT_EQ(split("a/* x /* y **/b /**/ c /*/ d */ e"), "a b c e");
  EXPECT_EQ(split("a // b"), "a / / b");
}

TEST(Tokens, NameTheLineWhereAnEndlessCommentBegins) {
  const Fault fault = faultOf("a\nb /* c\nd\n");
  EXPECT_EQ(fault.message, "this comment never ends");
  EXPECT_EQ(fault.place.line, 2u);
  EXPECT_TRUE(fault.hopeless);
}

TEST(Tokens, TakeACarriageReturnAsBlank) { EXPECT_EQ(split("a\r\nb\tc\n"), "a b c"); }

TEST(Tokens, TakeAControlZAsBlank) { EXPECT_EQ(split("a\r\nb\r\n\x1a"), "a b"); }

TEST(Tokens, TakeAByteOrderMarkAsBlank) {
  const std::string mark("\xef\xbb\xbf");
  EXPECT_EQ(split(mark), "");
  EXPECT_EQ(split(mark + "a b\n\x1a\n" + mark + "c"), "a b c");
  EXPECT_EQ(split(mark + "# 7 \"x\"\na"), "a");
  for (std::size_t piece : {1, 2}) {
    TextTokens t(mark + "a", piece);
    t.tokens.advance();
    EXPECT_EQ(describe(t.tokens.describe(t.tokens.current().place)), "scene.ray:1:1");
  }
  EXPECT_EQ(faultOf("\xef\xbb").message, "unexpected byte 0xef");
}

TEST(Tokens, RefuseBytesThatAreNoText) {
  EXPECT_EQ(faultOf("a & b").message, "unexpected `&`");
  EXPECT_FALSE(faultOf("a & b").hopeless);
  const Fault fault = faultOf(std::string("a\n\0b", 4));
  EXPECT_EQ(fault.message, "unexpected byte 0x00");
  EXPECT_EQ(fault.place.line, 2u);
  EXPECT_TRUE(fault.hopeless);
  EXPECT_EQ(faultOf("\x9b").message, "unexpected byte 0x9b");
}

TEST(Tokens, GoOnBehindAFault) {
  TextTokens t("& b");
  EXPECT_THROW(t.tokens.advance(), Fault);
  t.tokens.advance();
  EXPECT_EQ(t.tokens.text(), "b");
}

TEST(Tokens, FollowLineMarkers) {
  TextTokens t("a\n# 12 \"inc.ray\" 1\nb\n#line 3 \"scene.ray\"\nc # d");
  auto place = [&t] {
    t.tokens.advance();
    return describe(t.tokens.describe(t.tokens.current().place));
  };
  EXPECT_EQ(place(), "scene.ray:1:1");
  EXPECT_EQ(place(), "inc.ray:12:1");
  EXPECT_EQ(place(), "scene.ray:3:1");
  EXPECT_THROW(place(), Fault);  // a # that is not in the first column
}

TEST(Tokens, PrintNoControlBytesOfFileNames) {
  TextTokens t(std::string("# 1 \"\0a\x1b[1m\"\nb", 14));
  t.tokens.advance();
  EXPECT_EQ(t.tokens.describe(t.tokens.current().place).file, "?a?[1m");
}

TEST(Tokens, RefuseDirectives) {
  const Fault fault = faultOf("a\n#define b c\n");
  EXPECT_NE(fault.message.find("#define b c"), std::string::npos) << fault.message;
  EXPECT_EQ(fault.place.line, 2u);
}

TEST(Tokens, RefuseAnEndlessIncludeOnTheLineOfTheDirective) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += "# 1 \"loop.ray\" 1\nsphere\n\n";
  const Fault fault = faultOf(text);
  EXPECT_NE(fault.message.find("#include"), std::string::npos);
  EXPECT_EQ(fault.place.line, 2u);
  EXPECT_TRUE(fault.hopeless);
}

std::string fileNameIn(const std::string& text) {
  TextTokens t(text);
  t.tokens.advance();
  if (!t.tokens.fileNameFollows()) return "none";
  const std::string name = t.tokens.fileName();
  return name + "|" + std::string(t.tokens.text());
}

TEST(Tokens, ReadFileNamesWhereTheyAreWanted) {
  EXPECT_EQ(fileNameIn("a.map x"), "a.map|x");
  EXPECT_EQ(fileNameIn("dir/sub.d/a.map x"), "dir/sub.d/a.map|x");
  EXPECT_EQ(fileNameIn("/abs/a x"), "/abs/a|x");
  EXPECT_EQ(fileNameIn("//abs/a x"), "//abs/a|x");
  EXPECT_EQ(fileNameIn("./../a x"), "./../a|x");
  EXPECT_EQ(fileNameIn("image/a x"), "image/a|x");
  EXPECT_EQ(fileNameIn("image x"), "none");
  EXPECT_EQ(fileNameIn("12 x"), "none");
  EXPECT_EQ(fileNameIn("./ x"), "none");
  EXPECT_EQ(split("(a/b)"), "( a / b )");
}

TEST(Tokens, AreTheSameHoweverTheTextArrives) {
  std::string text;
  for (int i = 0; i < 3000; ++i) text += "sphere name-" + std::to_string(i) + " 1.5 -2e3 /* rest\n*/ (3)\n";
  const std::string whole = split(text);
  for (const std::size_t piece : {1, 7, 4096, 5000}) EXPECT_EQ(TextTokens(text, piece).all(), whole) << piece;
}

TEST(Tokens, ShowTheLineWithACaret) {
  TextTokens t("first\n\tsecond \x01 line\nthird", 3);
  t.tokens.advance();
  t.tokens.advance();
  EXPECT_EQ(t.tokens.excerpt(t.tokens.current().place), "  \tsecond ? line\n  \t^\n");
}

TEST(Tokens, ShowOnlyTheNeighbourhoodInALongLine) {
  TextTokens t(std::string(100000, ' ') + "word" + std::string(100000, ' '));
  t.tokens.advance();
  const Token token = t.tokens.current();
  EXPECT_EQ(describe(t.tokens.describe(token.place)), "scene.ray:1:100001");
  EXPECT_LT(t.tokens.excerpt(token.place).size(), 500u);
}

TEST(Tokens, ForgetLinesThatAreLongGone) {
  TextTokens t("first" + std::string(1 << 20, '\n') + "last");
  t.tokens.advance();
  const TokenPlace first = t.tokens.current().place;
  t.tokens.advance();
  EXPECT_EQ(t.tokens.text(), "last");
  EXPECT_EQ(t.tokens.current().place.line, (1u << 20) + 1);
  EXPECT_EQ(t.tokens.excerpt(first), "");
}

TEST(Tokens, RefuseEndlessWordsAndNumbers) {
  EXPECT_NE(faultOf(std::string(100000, 'a')).message.find("more than 4096"), std::string::npos);
  EXPECT_NE(faultOf(std::string(100000, '1')).message.find("more than 4096"), std::string::npos);
}

}  // namespace
}  // namespace rayshade
