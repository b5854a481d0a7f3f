// What the fuzzers have found, and what they begin with, is borne for good.
// guarded: reads bytes of others
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/fuzz/any_input.h"
#include "tests/support/program.h"

namespace rayshade {
namespace {

// A demand that is not met ends the program: the last file named is the one.
void replay(const std::string& corpus, void (*take)(std::span<const std::byte>)) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator("tests/fuzz/corpus/" + corpus)) {
    std::printf("%s\n", entry.path().c_str());
    const std::string input = readText(entry.path());
    take(std::as_bytes(std::span(input)));
    ++files;
  }
  EXPECT_GE(files, 4);
}

TEST(FuzzCorpus, EveryTextIsReadOrRefused) { replay("scene", takeAnyScene); }
TEST(FuzzCorpus, EveryPictureIsReadOrRefused) { replay("picture", takeAnyPicture); }
TEST(FuzzCorpus, EveryRowOfPacketsIsBorne) { replay("wire", takeAnyPackets); }

}  // namespace
}  // namespace rayshade
