// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/program/manual_page.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>

#include "rayshade/program/version.h"

namespace rayshade {
namespace {

// Text in which no character means anything to man.
std::string literal(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\\') {
      safe += "\\e";
    } else if (c == '-') {
      safe += "\\-";
    } else if (c == '\'' || (c == '.' && (safe.empty() || safe.back() == '\n'))) {
      safe += c == '.' ? "\\&." : "\\(aq";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string upperCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

// What it takes: of TEXT:{equal,cost} the words, of INT:1 to 8 the type, as often as it is wanted, and the range.
std::string valuesOf(const CLI::Option& option) {
  if (option.get_expected_max() == 0) return "";
  const std::string all = option.get_type_name(), type = all.substr(0, all.find(':'));
  std::string limits = all.substr(std::min(all.size(), type.size() + 1));
  if (limits.starts_with('{')) {
    std::replace(limits.begin(), limits.end(), ',', '|');
    return " " + literal(limits.substr(1, limits.size() - 2));
  }
  std::string values;
  for (int i = 0; i < std::max(1, option.get_expected_min()); ++i) values += " \\fI" + literal(type) + "\\fR";
  return values + (limits.empty() ? "" : " (" + literal(limits) + ")");
}

void add(std::string& page, const CLI::Option& option) {
  const std::string names = option.get_name(option.get_positional(), true);
  page += ".TP\n\\fB" + literal(names) + "\\fR" + valuesOf(option) + "\n" +
          literal(option.get_description()) + "\n";
}

}  // namespace

std::string manualPageOf(const CLI::App& app) {
  const std::string name = app.get_name();
  std::string page = ".TH " + upperCase(literal(name)) + " 1 \"\" \"" +
                     literal(nameAndVersion("rayshade-pvm")) + "\"\n.SH NAME\n" +
                     literal(app.get_description()) + "\n.SH SYNOPSIS\n\\fB" + literal(name) +
                     "\\fR [\\fIoptions\\fR]";
  std::vector<std::string> groups;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional())
      page += option->get_required() ? " \\fI" + literal(option->get_name(true)) + "\\fR"
                                     : " [\\fI" + literal(option->get_name(true)) + "\\fR]";
    const std::string group = option->get_positional() ? "Arguments" : option->get_group();
    if (!group.empty() && std::find(groups.begin(), groups.end(), group) == groups.end())
      groups.push_back(group);
  }
  page += "\n";
  std::stable_partition(groups.begin(), groups.end(), [](const std::string& g) { return g == "Arguments"; });
  for (const std::string& group : groups) {
    page += ".SH " + upperCase(literal(group)) + "\n";
    for (const CLI::Option* option : app.get_options()) {
      if ((option->get_positional() ? "Arguments" : option->get_group()) == group) add(page, *option);
    }
  }
  if (!app.get_footer().empty()) page += ".SH NOTES\n" + literal(app.get_footer()) + "\n";
  return page;
}

}  // namespace rayshade
