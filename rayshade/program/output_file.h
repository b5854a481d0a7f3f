// A file for figures, if it has a name; opened before there is anything to be written, so that a wrong name is found early.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

namespace rayshade {

class OutputFile {
 public:
  explicit OutputFile(const std::string& name) : name_(name) {
    if (name.empty()) return;
    file_.reset(std::fopen(name.c_str(), "w"));
    if (!file_) throw std::runtime_error(name + ": cannot be written");
  }
  explicit operator bool() const { return file_ != nullptr; }
  std::FILE* file() const { return file_.get(); }
  void close() {
    if (file_ && (std::ferror(file_.get()) != 0 || std::fclose(file_.release()) != 0))
      throw std::runtime_error(name_ + ": cannot be written");
  }

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string name_;
  std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace rayshade
