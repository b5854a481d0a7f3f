// Events as text for other programs.
//
//   tsv        one line per event, for scripts
//   perfetto   JSON of the Trace Event Format: slices, flows from encode to decode, counters (https://ui.perfetto.dev)
//   paje       Paje trace: states, links, variables (Debian: pajeng, vite)
//
// Source: "Trace Event Format" (Google); "Paje trace file", version 1.2.5 (L. M. Schnorr).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/events/event_file.h"

namespace rayshade {

void writeTsv(std::FILE* to, const EventFile& file);
void writePerfetto(std::FILE* to, const EventFile& file);
void writePaje(std::FILE* to, const EventFile& file);

}  // namespace rayshade
