// A file of figures by name: "name figure", one in a line; what follows the figure, and what follows #, is for people.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>

namespace rayshade {

class Figures {
 public:
  // Reads the file.  All of these throw std::runtime_error: file, line and what is wrong.
  explicit Figures(const std::string& fileName);

  double take(const std::string& name, double least, double most);
  std::optional<double> takeIfThere(const std::string& name, double least, double most);
  // A word in the place of the figure.
  std::string takeWord(const std::string& name);
  // Was everything taken?
  void finish() const;

  [[noreturn]] void complain(const std::string& name, const std::string& problem) const;

 private:
  struct Line {
    int number = 0;
    std::string value;
    bool taken = false;
  };
  std::string fileName_;
  std::map<std::string, Line> lines_;
};

}  // namespace rayshade
