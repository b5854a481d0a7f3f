// Arguments over a string: words and numbers apart by blanks, no expressions.
//
// inf and nan are numbers, which the language has none of; fail() throws std::runtime_error; warnings are kept; surface()
// gives the default surface without reading.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "rayshade/image/image_library.h"
#include "rayshade/shapes/arguments.h"

namespace rayshade {

class TextArguments final : public Arguments {
 public:
  explicit TextArguments(std::string_view text) {
    std::istringstream in{std::string(text)};
    for (std::string word; in >> word;) words_.push_back(word);
  }

  bool numberFollows() override { return at_ < words_.size() && numberIn(words_[at_]).has_value(); }
  bool accept(std::string_view word) override {
    const bool taken = at_ < words_.size() && words_[at_] == word;
    if (taken) ++at_;
    return taken;
  }
  bool fileNameFollows() override { return at_ < words_.size() && !numberFollows(); }
  std::string inputFile() override {
    if (at_ == words_.size()) fail("a file name is missing");
    namesFile_ = true;
    return words_[at_++];
  }
  std::shared_ptr<const Image> inputImage() override {
    auto read = images_.read(inputFile());
    if (const auto* problem = std::get_if<FileProblem>(&read)) fail(problem->message);
    return std::get<std::shared_ptr<const Image>>(std::move(read));
  }
  Surface surface() override { return defaultSurface(); }
  void warn(const std::string& message) override { warnings_.push_back(message); }
  [[noreturn]] void fail(const std::string& message) override { throw std::runtime_error(message); }

  bool allTaken() const { return at_ == words_.size(); }
  bool namesFile() const { return namesFile_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  double take(const Range& range, bool whole) override {
    std::optional<double> value = at_ < words_.size() ? numberIn(words_[at_]) : std::nullopt;
    if (!value) fail("a number is missing");
    ++at_;
    if (whole) value = std::trunc(*value);
    if (std::isfinite(*value) && !range.holds(*value)) fail(outOfRange(*value, range, whole));
    return *value;
  }

  static std::optional<double> numberIn(const std::string& word) {
    double value = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
  }

  ImageLibrary images_;
  std::vector<std::string> words_;
  std::size_t at_ = 0;
  bool namesFile_ = false;
  std::vector<std::string> warnings_;
};

}  // namespace rayshade
