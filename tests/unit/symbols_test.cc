// Of the C library's mathematical functions, only those may be used that are exact or correctly rounded: the others have
// other bits elsewhere (rayshade/base/elementary.h).
//
// The programs are asked which symbols they take from libraries, and the sources are read, too: compilers compute calls
// with constant arguments themselves.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

#include "tests/support/program.h"

namespace rayshade {
namespace {

const std::string kInexact =
    "(a?(sin|cos|tan)h?|atan2|sincos|exp(2|10|m1)?|log(2|10|1p)?|pow|cbrt|hypot|erfc?|[lt]?gamma(_r)?|[jy]["
    "01n])[fl]?";

std::string outputOf(const std::string& command) {
  std::string text;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  std::array<char, 4096> part;
  for (std::size_t n; pipe != nullptr && (n = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    text.append(part.data(), n);
  EXPECT_TRUE(pipe != nullptr && ::pclose(pipe) == 0) << command;
  return text;
}

TEST(Symbols, ProgramsUseNoInexactFunctionOfTheLibrary) {
  const std::regex inexact("\\bU " + kInexact + "(@\\S*)?\n");
  for (const char* program : {"rayshade", "rayshade-error", "rayshade-host", "spd"}) {
    const std::string symbols =
        outputOf("nm --dynamic --undefined-only " + programDirectory() + "/" + program);
    EXPECT_NE(symbols.find(" U memcpy"), std::string::npos) << program << ": is anything found at all?";
    for (std::sregex_iterator at(symbols.begin(), symbols.end(), inexact), end; at != end; ++at)
      ADD_FAILURE() << program << " uses " << at->str();
  }
  EXPECT_TRUE(std::regex_search(std::string("   U pow@GLIBC_2.29\n"), inexact));
  EXPECT_TRUE(std::regex_search(std::string("   U sincosf\n"), inexact));
}

TEST(Symbols, SourcesUseNoInexactFunctionOfTheLibrary) {
  const std::regex inexact("std::" + kInexact + "\\(");
  std::size_t looked = 0;
  for (const char* root : {"rayshade", "pvm", "scenes"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
      const std::filesystem::path& file = entry.path();
      if (file.extension() != ".cc" && file.extension() != ".h") continue;
      ++looked;
      std::ifstream in(file);
      // Regular expressions take long.
      for (std::string line; std::getline(in, line);)
        EXPECT_FALSE(line.find("std::") != std::string::npos && std::regex_search(line, inexact))
            << file << ": " << line;
    }
  EXPECT_GT(looked, 250u);
}

}  // namespace
}  // namespace rayshade
