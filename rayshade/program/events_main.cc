// The program `rayshade-events`: what was done when, as text for other programs.
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include "rayshade/events/event_export.h"
#include "rayshade/program/command_line.h"
#include "rayshade/program/option_values.h"
#include "rayshade/program/output_file.h"
#include "rayshade/program/run.h"

namespace {

using namespace rayshade;

struct Wishes {
  std::string events, format = "tsv", output;
};

int run(const Wishes& wishes) {
  const EventFile file = readEvents(wishes.events);
  OutputFile output(wishes.output);
  std::FILE* const to = output ? output.file() : stdout;
  if (wishes.format == "perfetto") {
    writePerfetto(to, file);
  } else if (wishes.format == "paje") {
    writePaje(to, file);
  } else {
    writeTsv(to, file);
  }
  output.close();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("rayshade-events - what a render did when, as text", "rayshade-events");
  Wishes wishes;
  app.add_option("events", wishes.events, "what --events of rayshade or rayshade-host has written")
      ->type_name(kFile)
      ->check(notEmpty())
      ->required();
  app.add_option("--format", wishes.format,
                 "tsv: a line for each event; perfetto: JSON for ui.perfetto.dev; paje: for pajeng and vite")
      ->check(CLI::IsMember({"tsv", "perfetto", "paje"}));
  app.add_option("-O", wishes.output, "output file; without: standard output")
      ->type_name(kFile)
      ->check(notEmpty());
  app.footer("Exit status: 0, 1 for bad files, 2 for a bad command line.");
  if (const std::optional<int> status = readCommandLine(app, argc, argv)) return *status;
  return runProgram(
      "rayshade-events", [&] { return run(wishes); }, [] { return "for the events: " + memoryOfProcess(); });
}
