// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/task_output.h"

#include <cstdio>
#include <utility>

namespace rayshade {
namespace {

constexpr std::size_t kLongestLine = 4096;  // a longer one is cut in two

void print(const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); }

}  // namespace

void TaskOutput::add(int task, std::string_view text) {
  std::string& line = unfinishedLine_[task];
  line += text;
  for (std::size_t end; (end = line.find('\n')) != std::string::npos; line.erase(0, end + 1))
    print(line.substr(0, end));
  if (line.size() > kLongestLine) print(std::exchange(line, ""));
  if (line.empty()) unfinishedLine_.erase(task);
}

void TaskOutput::end(int task) {
  const auto rest = unfinishedLine_.extract(task);
  if (!rest.empty()) print(rest.mapped());
}

void TaskOutput::forget(int task) { unfinishedLine_.erase(task); }

void TaskOutput::endAll() {
  for (const auto& [task, line] : unfinishedLine_) print(line);
  unfinishedLine_.clear();
}

}  // namespace rayshade
