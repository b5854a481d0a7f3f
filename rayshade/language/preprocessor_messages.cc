// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/preprocessor_messages.h"

#include <algorithm>
#include <optional>
#include <regex>
#include <sstream>

#include "rayshade/base/error.h"
#include "rayshade/base/file.h"

namespace rayshade {
namespace {

constexpr std::size_t kShown = 200;                           // bytes of a line
constexpr std::size_t kLargestSource = std::size_t{1} << 26;  // bytes

// The directive that includes `name`, at `from` or above it.
std::optional<SourcePlace> directiveThatIncludes(const std::string& name, const SourcePlace& from,
                                                 std::string& text) {
  const auto bytes = readFile(from.file, kLargestSource);
  if (!std::holds_alternative<Bytes>(bytes)) return std::nullopt;
  const auto& content = std::get<Bytes>(bytes);
  std::istringstream in(std::string(reinterpret_cast<const char*>(content.data()), content.size()));
  std::optional<SourcePlace> found;
  std::string line;
  for (std::uint32_t number = 1; number <= from.line && std::getline(in, line); ++number) {
    const std::size_t at = line.find(name);
    if (!line.starts_with('#') || line.find("include") > at || at == std::string::npos) continue;
    found = SourcePlace{from.file, number, static_cast<std::uint32_t>(at + 1)};
    text = line;
  }
  return found;
}

std::string excerpt(const std::string& line, std::uint32_t column) {
  const std::string shown = "\n  " + printable(line.substr(0, kShown));
  if (column > kShown) return shown;
  return shown + "\n  " + caretBehind(std::string_view(line).substr(0, std::max(column, 1u) - 1));
}

}  // namespace

std::vector<PreprocessorMessage> preprocessorMessages(const std::string& said) {
  static const std::regex head("(.+?):([0-9]+):(?:([0-9]+):)? (fatal error|error|warning|note): (.*)");
  static const std::regex shownLine(" *[0-9]+ \\| ?(.*)");
  static const std::regex notIncluded("(.*): ([^:]*)");
  static const std::regex option(" \\[-W[a-z-]+\\]$");
  std::vector<std::string> lines;
  std::istringstream in(said);
  for (std::string line; std::getline(in, line);) {
    // No byte of a file's name may colour a message.
    std::replace_if(
        line.begin(), line.end(),
        [](char c) { return (static_cast<unsigned char>(c) < ' ' && c != '\t') || c == 0x7f; }, '?');
    lines.push_back(line);
  }

  std::vector<PreprocessorMessage> messages;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::smatch part;
    if (!std::regex_match(lines[i], part, head)) {
      // Not of a place: of cpp's arguments.  All else is a line, a caret, or the way to an included file.
      if (lines[i].starts_with("cpp: ") || lines[i].starts_with("cc1: "))
        messages.push_back({false, lines[i], lines[i]});
      continue;
    }
    SourcePlace place{
        part[1], static_cast<std::uint32_t>(std::stoul(part[2].str().substr(0, 9))),
        part[3].matched ? static_cast<std::uint32_t>(std::stoul(part[3].str().substr(0, 9))) : 1};
    const bool fatal = part[4] == "fatal error";
    std::string kind = fatal ? "error" : part[4].str();
    std::string text = std::regex_replace(part[5].str(), option, ""), line;
    std::smatch shown, missing;
    if (i + 1 < lines.size() && std::regex_match(lines[i + 1], shown, shownLine)) line = shown[1];
    if (fatal && std::regex_match(text, missing, notIncluded)) {
      const std::string name = missing[1], why = missing[2];
      text = "`" + name + "` cannot be included: " + why;
      if (const auto directive = directiveThatIncludes(name, place, line)) {
        place = *directive;
      } else {
        line.clear();
      }
    }
    messages.push_back(
        {kind != "error", text,
         describe(place) + ": " + kind + ": " + text + (line.empty() ? "" : excerpt(line, place.column))});
  }
  return messages;
}

}  // namespace rayshade
