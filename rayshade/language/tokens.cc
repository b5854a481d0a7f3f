// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/tokens.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>

namespace rayshade {
namespace {

constexpr std::size_t kShown = 100;  // bytes of a line shown on either side of a caret

enum class Class : std::uint8_t { other, space, newline, letter, digit, symbol };

constexpr std::array<Class, 256> kClasses = [] {
  std::array<Class, 256> classes{};
  // differs from rayshade4: a carriage return is white space, with and without the preprocessor; so are the
  // Ctrl-Z that ends old files, and the byte order mark.
  for (const char c : {' ', '\t', '\r', '\f', '\v', '\x1a'})
    classes[static_cast<unsigned char>(c)] = Class::space;
  classes['\n'] = Class::newline;
  for (int c = 'a'; c <= 'z'; ++c) classes[static_cast<std::size_t>(c)] = Class::letter;
  for (int c = 'A'; c <= 'Z'; ++c) classes[static_cast<std::size_t>(c)] = Class::letter;
  for (int c = '0'; c <= '9'; ++c) classes[static_cast<std::size_t>(c)] = Class::digit;
  for (const char c : {'(', ')', ',', '+', '-', '*', '/', '%', '^', '.'})
    classes[static_cast<unsigned char>(c)] = Class::symbol;
  return classes;
}();

Class classOf(char c) { return kClasses[static_cast<unsigned char>(c)]; }

constexpr std::array<bool, 256> kInName = [] {
  std::array<bool, 256> in{};
  for (std::size_t c = 0; c < 256; ++c) in[c] = kClasses[c] == Class::letter || kClasses[c] == Class::digit;
  in['.'] = in['_'] = in['-'] = true;
  return in;
}();

bool inName(char c) { return kInName[static_cast<unsigned char>(c)]; }

// The end of a name that begins at `p`; p itself when there is none.
const char* endOfName(const char* p) {
  if (classOf(*p) != Class::letter) return p;
  while (inName(*p)) ++p;
  return p;
}

// The end of a file name: [/ or //] then any of ./ ../ name/ then a name; `p` itself when there is none.
const char* endOfFileName(const char* const p) {
  const char* q = p;
  for (int i = 0; i < 2 && *q == '/'; ++i) ++q;
  while (true) {
    if (q[0] == '.' && q[1] == '/') {
      q += 2;
    } else if (q[0] == '.' && q[1] == '.' && q[2] == '/') {
      q += 3;
    } else {
      const char* const end = endOfName(q);
      if (end == q) return p;
      if (*end != '/' || end[1] == '*') return end;  // a comment may follow the name
      q = end + 1;
    }
  }
}

std::string shown(char c) {
  if (c >= ' ' && c <= '~') return std::string("`") + c + "`";
  constexpr char kDigits[] = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(c);
  return std::string("byte 0x") + kDigits[byte >> 4] + kDigits[byte & 15];
}

}  // namespace

std::uint32_t FileNames::numberOf(std::string_view name) {
  std::string printable(name);  // it goes into messages: no byte may end or colour them
  std::replace_if(
      printable.begin(), printable.end(),
      [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 0x7f; }, '?');
  const auto [at, isNew] = numbers_.try_emplace(printable, static_cast<std::uint32_t>(names_.size()));
  if (isNew) names_.push_back(printable);
  return at->second;
}

Tokens::Tokens(ReadText read, const std::string& fileName) : text_(std::move(read)) {
  file_ = files_.numberOf(fileName);
}

void Tokens::newLine() {
  ++line_;
  lineStart_ = text_.offsetOf(text_.next);
}

void Tokens::fault(std::string message, const char* at, bool hopeless) {
  token_ = {Token::Kind::symbol, '\0', {}, 0, 0, placeOf(text_.next)};  // none: the last one is gone
  throw Fault{std::move(message), placeOf(at), hopeless};
}

void Tokens::advance() {
  while (true) {
    if (text_.left() < kLongestToken + 2) text_.needAhead(kLongestToken + 2);
    const char c = *text_.next;
    switch (classOf(c)) {
      case Class::space:
        ++text_.next;
        continue;
      case Class::newline:
        ++text_.next;
        newLine();
        continue;
      case Class::letter: {
        const char* const end = endOfName(text_.next);
        if (static_cast<std::size_t>(end - text_.next) > kLongestToken) {
          const char* const begin = text_.next;
          text_.next = end;
          fault("a word of more than 4096 characters", begin);
        }
        token_.keyword = findKeyword({text_.next, static_cast<std::size_t>(end - text_.next)});
        return finish(Token::Kind::word, end);
      }
      case Class::digit:
        return readNumber();
      case Class::symbol:
        if (c == '/' && text_.next[1] == '*') {
          skipComment();
          continue;
        }
        if (c == '.' && classOf(text_.next[1]) == Class::digit) return readNumber();
        token_.symbol = c;
        return finish(Token::Kind::symbol, text_.next + 1);
      case Class::other:
        if (text_.next == text_.end()) return finish(Token::Kind::end, text_.next);
        if (std::string_view(text_.next, text_.left()).starts_with(kByteOrderMark)) {
          const bool first = text_.offsetOf(text_.next) == lineStart_;
          text_.next += kByteOrderMark.size();
          if (first) lineStart_ = text_.offsetOf(text_.next);  // no column for it
          continue;
        }
        if (c == '#' && text_.offsetOf(text_.next) == lineStart_) {
          readMarker();
          continue;
        }
        ++text_.next;
        // A byte that no text has: this is a picture, an archive, a program...
        fault("unexpected " + shown(c), text_.next - 1, c < ' ' || c == 0x7f);
    }
  }
}

void Tokens::finish(Token::Kind kind, const char* end) {
  token_.kind = kind;
  token_.place = placeOf(text_.next);
  token_.length = static_cast<std::uint32_t>(end - text_.next);
  text_.next = end;
}

void Tokens::readNumber() {
  const char* const begin = text_.next;
  const auto [end, error] = std::from_chars(begin, text_.end(), token_.value);
  if (end - begin > static_cast<std::ptrdiff_t>(kLongestToken)) {
    text_.next = end;
    fault("a number of more than 4096 characters", begin);
  }
  if (error == std::errc::result_out_of_range) {
    // Too small is 0, too large is an error; strtod tells them apart.
    if (std::strtod(std::string(begin, end).c_str(), nullptr) > 1) {
      text_.next = end;
      fault("the number " + std::string(begin, end) + " is too large", begin);
    }
    token_.value = 0;
  }
  finish(Token::Kind::number, end);
}

void Tokens::skipComment() {
  const TokenPlace begin = placeOf(text_.next);
  text_.next += 2;
  while (true) {
    if (text_.left() < 2) text_.needAhead(2);
    if (text_.next == text_.end()) throw Fault{"this comment never ends", begin, true};
    const char c = *text_.next++;
    if (c == '\n') {
      newLine();
    } else if (c == '*' && *text_.next == '/') {
      ++text_.next;
      return;
    }
  }
}

// `# 12 "file" flags` or `# line 12 "file"`, up to the end of its line.
void Tokens::readMarker() {
  const char* const begin = text_.next;
  const char* p = text_.next + 1;
  const char* const end = std::find(p, text_.end(), '\n');
  auto skipBlanks = [&] {
    while (p < end && (*p == ' ' || *p == '\t' || *p == '\r')) ++p;
  };
  skipBlanks();
  if (end - p > 4 && std::string_view(p, 4) == "line") p += 4;
  skipBlanks();
  std::uint32_t line = 0;
  const auto [behind, error] = std::from_chars(p, end, line);
  if (error != std::errc{}) {
    const std::string_view directive(begin,
                                     static_cast<std::size_t>(std::min(end - begin, std::ptrdiff_t{30})));
    text_.next = end;
    fault("unexpected `" + std::string(directive) + "`: preprocessor directives are not read here", begin);
  }
  p = behind;
  skipBlanks();
  std::uint32_t file = file_;
  if (p < end && *p == '"') {
    const char* const close = std::find(p + 1, end, '"');
    file = files_.numberOf({p + 1, static_cast<std::size_t>(close - p - 1)});
    p = close < end ? close + 1 : end;
    skipBlanks();
    if (p < end && *p == '1' && ++includeDepth_ > kDeepestInclude) {
      TokenPlace directive = placeOf(begin);  // on the line before, as cpp counts; its text is gone
      directive.lineStart = directive.offset + 1;
      directive.line -= std::min(directive.line, 1u);
      throw Fault{"#include nested more than 60 deep: does the file include itself?", directive, true};
    }
    if (p < end && *p == '2') --includeDepth_;
  }
  file_ = file;
  line_ = line;
  text_.next = end;
  if (text_.next < text_.end()) ++text_.next;
  lineStart_ = text_.offsetOf(text_.next);
}

bool Tokens::firstInLine() const {
  const TokenPlace& place = token_.place;
  const std::uint64_t start = std::max(place.lineStart, text_.start());
  const std::string_view before = text_.text(start, static_cast<std::size_t>(place.offset - start));
  return std::all_of(before.begin(), before.end(), [](char c) { return classOf(c) == Class::space; });
}

bool Tokens::fileNameFollows() const {
  if (token_.kind == Token::Kind::end) return false;
  const char* const begin = text_.at(token_.place.offset);
  const char* const end = endOfFileName(begin);
  if (end == begin) return false;
  // A word alone must not be reserved; with a directory in front it cannot be mistaken.
  return token_.keyword.word == Word::none || token_.kind != Token::Kind::word || end > begin + token_.length;
}

std::string Tokens::fileName() {
  const char* const begin = text_.at(token_.place.offset);
  if (!fileNameFollows()) throw Fault{"a file name is expected here", token_.place};
  const char* const end = endOfFileName(begin);
  if (static_cast<std::size_t>(end - begin) > kLongestToken)
    throw Fault{"a file name of more than 4096 characters", token_.place};
  std::string name(begin, end);
  text_.next = end;
  advance();
  return name;
}

SourcePlace Tokens::describe(const TokenPlace& place) const {
  const std::uint64_t column = place.offset + 1 - std::min(place.lineStart, place.offset);
  return {files_[place.file], place.line, static_cast<std::uint32_t>(column)};
}

std::string Tokens::excerpt(const TokenPlace& place) {
  if (place.offset < std::max(text_.start(), place.lineStart)) return "";
  // The rest of the line may still be unread.
  const std::uint64_t wanted = place.offset + kShown;
  if (const std::uint64_t held = text_.offsetOf(text_.end()); wanted > held)
    text_.needAhead(static_cast<std::size_t>(wanted - text_.offsetOf(text_.next)));
  if (place.offset < text_.start()) return "";

  const std::uint64_t firstShown = place.offset > kShown ? place.offset - kShown : 0;
  const std::uint64_t start = std::max({place.lineStart, firstShown, text_.start()});
  const std::uint64_t stop = std::min(wanted, text_.offsetOf(text_.end()));
  const std::string_view before = text_.text(start, static_cast<std::size_t>(place.offset - start));
  std::string_view after = text_.text(place.offset, static_cast<std::size_t>(stop - place.offset));
  after = after.substr(0, after.find('\n'));
  if (!after.empty() && after.back() == '\r') after.remove_suffix(1);

  return "  " + printable(before) + printable(after) + "\n  " + caretBehind(before) + "\n";
}

}  // namespace rayshade
