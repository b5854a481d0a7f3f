// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/simulation/figures.h"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace rayshade {

Figures::Figures(const std::string& fileName) : fileName_(fileName) {
  std::ifstream in(fileName);
  if (!in) throw std::runtime_error(fileName + ": cannot be read");
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    std::istringstream words(line.substr(0, line.find('#')));
    std::string name, value;
    if (!(words >> name)) continue;
    const std::string place = fileName + ":" + std::to_string(number) + ": ";
    if (!(words >> value)) throw std::runtime_error(place + name + " has no value");
    if (!lines_.try_emplace(name, Line{number, value}).second)
      throw std::runtime_error(place + name + " is said twice");
  }
}

void Figures::complain(const std::string& name, const std::string& problem) const {
  const auto line = lines_.find(name);
  throw std::runtime_error(fileName_ +
                           (line == lines_.end() ? "" : ":" + std::to_string(line->second.number)) + ": " +
                           name + " " + problem);
}

std::string Figures::takeWord(const std::string& name) {
  const auto line = lines_.find(name);
  if (line == lines_.end()) complain(name, "is missing");
  line->second.taken = true;
  return line->second.value;
}

double Figures::take(const std::string& name, double least, double most) {
  const std::string word = takeWord(name);
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (*end != '\0' || !(value >= least && value <= most)) {
    std::ostringstream range;
    range << "must be a number from " << least << " to " << most;
    complain(name, range.str());
  }
  return value;
}

std::optional<double> Figures::takeIfThere(const std::string& name, double least, double most) {
  if (!lines_.contains(name)) return std::nullopt;
  return take(name, least, most);
}

void Figures::finish() const {
  for (const auto& [name, line] : lines_)
    if (!line.taken) complain(name, "is not known here");
}

}  // namespace rayshade
