// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/program/completions.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "rayshade/program/option_values.h"

namespace rayshade {
namespace {

// -h,--help -> -h|--help
std::string namesOf(const CLI::Option& option, char between) {
  std::string names = option.get_name(false, true);
  std::replace(names.begin(), names.end(), ',', between);
  return names;
}

// The command that lists what a value may be: of TEXT:{equal,cost} the words.
std::string valuesOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (type.starts_with(kScene)) return "compgen -f -X '!*.ray' -- \"$word\"; compgen -d -- \"$word\"";
  if (type.starts_with(kFile)) return "compgen -f -- \"$word\"";
  const std::size_t open = type.find('{'), close = type.rfind('}');
  if (open == std::string::npos || close == std::string::npos) return ":";
  std::string words = type.substr(open + 1, close - open - 1);
  std::replace(words.begin(), words.end(), ',', ' ');
  return "compgen -W '" + words + "' -- \"$word\"";
}

}  // namespace

std::string completionsOf(const CLI::App& app) {
  const std::string program = app.get_name();
  std::string function = "_" + program;
  std::replace(function.begin(), function.end(), '-', '_');
  std::string options, values, others = ":";
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) {
      if (others == ":") others = valuesOf(*option);
    } else if (!option->get_group().empty()) {
      options += (options.empty() ? "" : " ") + namesOf(*option, ' ');
      if (option->get_expected_max() > 0)
        values += "    " + namesOf(*option, '|') + ") " + valuesOf(*option) + " ;;\n";
    }
  }
  return "# Completions of " + program + " for bash; written by " + program + " --completions.\n" + function +
         "_words() {\n  case $before in\n" + values + "    *) if [[ $word == -* ]]; then compgen -W '" +
         options + "' -- \"$word\"; else " + others + "; fi ;;\n  esac\n}\n" + function +
         "() {\n  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
         "  mapfile -t COMPREPLY < <(" +
         function + "_words)\n}\ncomplete -o filenames -F " + function + " " + program + "\n";
}

}  // namespace rayshade
