// The examples in the documents, as scenes that can be read.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace rayshade {

inline std::string textOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// The blocks between ```rayshade and ```.
inline std::vector<std::string> examplesOf(const std::string& document) {
  const std::string text = textOf(document), open = "\n```rayshade\n", close = "\n```\n";
  std::vector<std::string> examples;
  for (std::size_t at = text.find(open); at != std::string::npos; at = text.find(open, at)) {
    at += open.size();
    const std::size_t end = text.find(close, at);
    examples.push_back(text.substr(at, end == std::string::npos ? end : end - at) + "\n");
  }
  return examples;
}

// A file of its own, because the preprocessor reads files.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text) {
    std::string name = (std::filesystem::temp_directory_path() / "language-XXXXXX").string();
    close(mkstemp(name.data()));
    name_ = name;
    std::ofstream(name_, std::ios::binary) << text;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { std::filesystem::remove(name_); }
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

}  // namespace rayshade
