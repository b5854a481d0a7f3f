// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

namespace rayshade {

std::variant<std::string, FileProblem> findFile(const std::string& name, const std::string& namedIn) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path beside = fs::path(namedIn).parent_path().lexically_normal();
  std::vector<std::string> places = {name};
  const bool elsewhere = !beside.empty() && beside != "." && fs::path(name).is_relative();
  if (elsewhere) places.push_back((beside / name).string());
  for (const std::string& place : places)
    if (fs::is_regular_file(place, ignored)) return place;
  for (const std::string& place : places)
    if (fs::exists(place, ignored)) return place;  // what is wrong with it, the reader says
  if (!elsewhere) return FileProblem{name + ": no such file"};
  return FileProblem{name + ": no such file, neither where the program runs nor in " + beside.string()};
}

std::variant<Bytes, FileProblem> readFile(const std::string& name, std::size_t most) {
  auto problem = [&name](const std::string& what) { return FileProblem{name + ": " + what}; };
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(name, error);
  if (!std::filesystem::exists(status)) return problem("no such file");
  if (!std::filesystem::is_regular_file(status)) return problem("is not a file with contents");
  const std::uintmax_t size = std::filesystem::file_size(name, error);
  if (error) return problem(error.message());
  if (size > most) return problem("is larger than " + std::to_string(most) + " bytes");

  std::ifstream in(name, std::ios::binary);
  if (!in) return problem(std::strerror(errno));
  Bytes bytes(static_cast<std::size_t>(size));
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (static_cast<std::size_t>(in.gcount()) != bytes.size()) return problem("cannot be read to its end");
  return bytes;
}

}  // namespace rayshade
