// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/host_file.h"

#include <cstdlib>
#include <sstream>

namespace rayshade {

std::vector<HostLine> readHostFile(std::istream& in) {
  std::vector<HostLine> hosts;
  std::string defaults;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string name, options;
    if (!(words >> name) || name[0] == '#') continue;
    const bool isDefault = name == "*";
    if (name[0] == '&') continue;  // only options, for a host that somebody may add later
    for (std::string option; words >> option;) options += (options.empty() ? "" : " ") + option;
    if (isDefault)
      defaults = options;
    else
      hosts.push_back({name, defaults + (defaults.empty() || options.empty() ? "" : " ") + options});
  }
  return hosts;
}

int speedOf(const HostLine& line) {
  int speed = 1000;
  std::istringstream words(line.options);
  for (std::string word; words >> word;) {
    if (!word.starts_with("sp=")) continue;
    const long value = std::strtol(word.c_str() + 3, nullptr, 10);
    if (value >= 1 && value <= 1'000'000) speed = static_cast<int>(value);
  }
  return speed;
}

}  // namespace rayshade
