// What the command lines of all programs have in common.
//
// Each program knows its manual page and its completions, because they follow from its options: `make` asks it.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

namespace rayshade {

// Adds --help, --version and what `make` asks for, and reads the command line.  Says what is wrong with it, in one line, or
// what it asks for; then, and only then, there is a status to leave with.
std::optional<int> readCommandLine(CLI::App& app, int argc, char** argv);

}  // namespace rayshade
