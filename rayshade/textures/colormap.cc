// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/textures/colormap.h"

#include <charconv>
#include <optional>

namespace rayshade {
namespace {

constexpr std::size_t kEntries = 256;
constexpr std::size_t kLargestFile = 1 << 20;
constexpr std::string_view kBlanks = " \t\r";

std::string_view withoutBlanks(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text;
}

// A channel from the front of a line, as a share of 255.
std::optional<double> takeChannel(std::string_view& line) {
  line = withoutBlanks(line);
  int value = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
  if (error != std::errc() || value < 0 || value > 255) return std::nullopt;
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  return value / 255.0;
}

std::optional<Color> colorOf(std::string_view line) {
  const auto r = takeChannel(line), g = takeChannel(line), b = takeChannel(line);
  if (!r || !g || !b || !withoutBlanks(line).empty()) return std::nullopt;
  return Color{*r, *g, *b};
}

}  // namespace

std::variant<Colormap, FileProblem> decodeColormap(std::string_view text, const std::string& name) {
  Colormap map;
  for (int number = 1; !text.empty() && map.colors.size() < kEntries; ++number) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (withoutBlanks(line).empty()) continue;
    const auto color = colorOf(line);
    if (!color)
      return FileProblem{name + ":" + std::to_string(number) + ": not three whole numbers from 0 to 255"};
    map.colors.push_back(*color);
  }
  return map;
}

Colormap parseColormap(Arguments& in) {
  const std::string name = in.inputFile();
  const auto bytes = readFile(name, kLargestFile);
  if (const auto* problem = std::get_if<FileProblem>(&bytes)) in.fail(problem->message);
  const Bytes& text = std::get<Bytes>(bytes);
  auto map = decodeColormap({reinterpret_cast<const char*>(text.data()), text.size()}, name);
  if (const auto* problem = std::get_if<FileProblem>(&map)) in.fail(problem->message);
  return std::get<Colormap>(std::move(map));
}

}  // namespace rayshade
