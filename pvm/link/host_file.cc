// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/host_file.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <sstream>

#include "pvm/link/daemon_process.h"

namespace rayshade {
namespace {

constexpr long kMostSpeed = 1'000'000;       // PVM takes 1 to this
constexpr long kMostMemory = 1'000'000'000;  // MB

// A whole number from 1 to `most` behind `word=`; `at`: for messages.
long numberIn(const std::string& option, long most, const std::string& at) {
  const std::string_view text = std::string_view(option).substr(option.find('=') + 1);
  long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 1 || value > most)
    throw MachineError(at + ": " + option + ": a whole number from 1 to " + std::to_string(most) +
                       " is expected");
  return value;
}

int speedOf(const std::string& options, const std::string& at) {
  int speed = HostLine{}.speed;
  std::istringstream words(options);
  for (std::string word; words >> word;)
    if (word.starts_with("sp=")) speed = static_cast<int>(numberIn(word, kMostSpeed, at));
  return speed;
}

// What comment lines say of memory.
struct SaidMemory {
  std::map<std::string, std::pair<std::uint64_t, std::string>> ofHost;  // bytes, and where it was said
  std::uint64_t ofOthers = 0;

  void read(std::istringstream& words, const std::string& at) {
    std::string program, memory;
    if (!(words >> program >> memory) || program != "rayshade" || !memory.starts_with("memory=")) return;
    const std::uint64_t bytes = static_cast<std::uint64_t>(numberIn(memory, kMostMemory, at)) * 1'000'000;
    bool named = false;
    for (std::string name; words >> name; named = true) ofHost[name] = {bytes, at};
    if (!named) ofOthers = bytes;
  }

  void tell(std::vector<HostLine>& hosts) const {
    for (HostLine& host : hosts) {
      const auto said = ofHost.find(host.name);
      host.memory = said == ofHost.end() ? ofOthers : said->second.first;
    }
    for (const auto& [name, said] : ofHost)
      if (std::ranges::find(hosts, name, &HostLine::name) == hosts.end())
        throw MachineError(said.second + ": no line of the file has the host " + name);
  }
};

}  // namespace

std::vector<HostLine> readHostFile(std::istream& in, const std::string& file) {
  std::vector<HostLine> hosts;
  std::string defaults;
  SaidMemory memory;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    const std::string at = file + ":" + std::to_string(++number);
    std::istringstream words(line);
    std::string name, options;
    if (!(words >> name)) continue;
    if (name == "#") memory.read(words, at);
    if (name[0] == '#' || name[0] == '&')
      continue;  // &: only options, for a host that somebody may add later
    for (std::string option; words >> option;) options += (options.empty() ? "" : " ") + option;
    const int speed = speedOf(options, at);
    if (name == "*") {
      defaults = options;
      continue;
    }
    const bool own = (" " + options).find(" sp=") != std::string::npos;
    hosts.push_back({name, defaults + (defaults.empty() || options.empty() ? "" : " ") + options,
                     own ? speed : speedOf(defaults, at), 0});
  }
  memory.tell(hosts);
  return hosts;
}

}  // namespace rayshade
