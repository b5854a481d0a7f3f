// Finding a file, and reading a whole one that may be anything: missing, a directory, endless, or far too large.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <variant>

#include "rayshade/base/archive.h"

namespace rayshade {

// Why a file is of no use; a complete message that begins with the name of the file.
struct FileProblem {
  std::string message;
};

// Where the file lies that another one names: where the program runs, or else beside that other one.
// differs from rayshade4: that looks where it runs.
std::variant<std::string, FileProblem> findFile(const std::string& name, const std::string& namedIn);

// Only of regular files, and of at most `most` bytes, so that the size is known before memory is taken.
std::variant<Bytes, FileProblem> readFile(const std::string& name, std::size_t most);

}  // namespace rayshade
