// What the values of options may be, and what is said of others: one line, before anything is done.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <string>

namespace rayshade {

// Types of values that are names of files: what is completed behind the option.  The second one ends with .ray.
inline constexpr const char* kFile = "FILE";
inline constexpr const char* kScene = "SCENE";

// For transform().  Not CLI::Range, which lets through what is not a number; and CLI11 reads through a long double, which is
// not the same on every processor, so the text becomes one that is exact.
CLI::Validator numberFrom(double low, double high);

template <class Whole>
CLI::Validator wholeNumberFrom(Whole low, Whole high) {
  const std::string range = std::to_string(low) + " to " + std::to_string(high);
  return CLI::Validator(
      [=](const std::string& text) {
        Whole value{};
        const char* const end = text.data() + text.size();
        const auto [stopped, error] = std::from_chars(text.data(), end, value);
        const bool good = error == std::errc() && stopped == end && value >= low && value <= high;
        return good ? std::string() : "`" + text + "` is not a whole number from " + range;
      },
      range);
}

// The name of something: an empty one is a variable of the shell that is not set.
CLI::Validator notEmpty();

// The name of a picture that is to be written: its ending says a format.
CLI::Validator pictureFile();

}  // namespace rayshade
