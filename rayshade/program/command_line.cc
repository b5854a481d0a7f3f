// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/program/command_line.h"

#include <cstdio>

#include "rayshade/program/completions.h"
#include "rayshade/program/manual_page.h"
#include "rayshade/program/version.h"

namespace rayshade {

std::optional<int> readCommandLine(CLI::App& app, int argc, char** argv) {
  bool manualPage = false, completions = false;
  app.set_help_flag("-h,--help", "show this and leave");
  app.set_version_flag(
      "--version", [&app] { return versionText(app.get_name()); }, "show what this is and leave");
  app.add_flag("--manual-page", manualPage)->group("");
  app.add_flag("--completions", completions)->group("");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    // --manual-page works where an argument is missing, too.
    if (!manualPage && !completions) {
      std::fprintf(stderr, "%s: %s (%s --help explains)\n", app.get_name().c_str(), error.what(),
                   app.get_name().c_str());
      return 2;
    }
  }
  if (!manualPage && !completions) return std::nullopt;
  std::fputs((manualPage ? manualPageOf(app) : completionsOf(app)).c_str(), stdout);
  return 0;
}

}  // namespace rayshade
