// Tokens of the input language, from a stream of any length.
//
// Only a window of the text is held (text_window.h).  A token's text is good until the next token is asked for.  Names are a
// letter and then letters, digits and . _ -, so `length-1` is one name; a file name may have directories in it and is read
// by fileName() where the grammar wants one, so that `(a/b)` stays a division (differs from rayshade4, where it is a file
// name).
//
// A `#` in the first column begins a line marker of the C preprocessor; it sets the file and line of what
// follows.  Any other `#` line there, a byte that is no text, or a comment without an end is a fault.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "rayshade/base/error.h"
#include "rayshade/language/keywords.h"
#include "rayshade/language/text_window.h"

namespace rayshade {

// Where something stands, cheap enough for every token.
struct TokenPlace {
  std::uint64_t offset = 0;     // from the beginning of the text                                     [bytes]
  std::uint64_t lineStart = 0;  // offset of its line; behind `offset`: its text is gone
  std::uint32_t line = 1;
  std::uint32_t file = 0;  // number of a file's name
};

struct Token {
  enum class Kind : std::uint8_t { end, word, number, symbol };
  Kind kind = Kind::end;
  char symbol = 0;   // of a symbol
  Keyword keyword;   // of a word; Word::none when it is a name
  double value = 0;  // of a number
  std::uint32_t length = 0;
  TokenPlace place;
};

// Some editors put it before UTF-8.  White space.
inline constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

// What is wrong with the text.  After a hopeless one there is no point in reading on.
struct Fault {
  std::string message;
  TokenPlace place;
  bool hopeless = false;
};

// The files that a text names, by number.
class FileNames {
 public:
  std::uint32_t numberOf(std::string_view name);
  const std::string& operator[](std::uint32_t number) const { return names_[number]; }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::uint32_t> numbers_;
};

class Tokens {
 public:
  static constexpr std::size_t kLongestToken = 4096;  // bytes
  static constexpr int kDeepestInclude = 60;

  // The first token is there after the first advance().
  Tokens(ReadText read, const std::string& fileName);

  const Token& current() const { return token_; }
  std::string_view text() const { return text_.text(token_.place.offset, token_.length); }
  bool firstInLine() const;  // nothing but blanks stands before the current token
  void advance();            // throws Fault; asked again after that, it goes on behind what was wrong

  // Is the current token the beginning of a file name?  Reads it and advances, in one.
  bool fileNameFollows() const;
  std::string fileName();

  SourcePlace describe(const TokenPlace& place) const;
  // The line of a place with a caret below, both ended by newlines; empty when it is no longer held.
  std::string excerpt(const TokenPlace& place);

 private:
  TokenPlace placeOf(const char* p) const { return {text_.offsetOf(p), lineStart_, line_, file_}; }
  void newLine();  // behind a newline
  void skipComment();
  void readMarker();
  void readNumber();
  void finish(Token::Kind kind, const char* end);
  [[noreturn]] void fault(std::string message, const char* at, bool hopeless = false);

  TextWindow text_;
  std::uint64_t lineStart_ = 0;
  std::uint32_t line_ = 1, file_ = 0;
  int includeDepth_ = 0;
  FileNames files_;
  Token token_;
};

}  // namespace rayshade
