// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "rayshade/base/clock.h"

namespace rayshade {
Program::Program(const std::vector<std::string>& arguments, const std::string& scratch,
                 const Environment& environment, const std::string& directory)
    : begin_(steadySeconds()), outputFile_(scratch + ".out"), errorFile_(scratch + ".err") {
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("fork");
  if (pid_ > 0) return;
  const int in = open("/dev/null", O_RDONLY);
  const int out = open(outputFile_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int err = open(errorFile_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (in < 0 || out < 0 || err < 0 || dup2(in, 0) < 0 || dup2(out, 1) < 0 || dup2(err, 2) < 0) _exit(126);
  if (!directory.empty() && chdir(directory.c_str()) != 0) _exit(126);
  becomeProgram(arguments, environment);
}

Program::~Program() {
  if (!done_) wait(0);
}

bool Program::running() {
  if (!done_) {
    int status = 0;
    rusage usage{};
    if (wait4(pid_, &status, WNOHANG, &usage) != pid_) return true;
    Finished finished;
    finished.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    finished.output = readText(outputFile_);
    finished.errors = readText(errorFile_);
    finished.seconds = steadySeconds() - begin_;
    finished.peakKilobytes = usage.ru_maxrss;
    done_ = finished;
  }
  return false;
}

Finished Program::wait(double seconds) {
  const double deadline = steadySeconds() + seconds;
  bool inTime = true;
  while (running()) {
    if (inTime && steadySeconds() >= deadline) {
      inTime = false;
      kill(pid_, SIGKILL);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  done_->inTime = inTime;
  return *done_;
}

void becomeProgram(const std::vector<std::string>& arguments, const Program::Environment& environment) {
  for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
  std::vector<char*> list;
  for (const std::string& argument : arguments) list.push_back(const_cast<char*>(argument.c_str()));
  list.push_back(nullptr);
  execvp(list[0], list.data());
  _exit(127);
}

std::string programDirectory() {
  const char* given = std::getenv("RAYSHADE_BIN");
  return std::filesystem::absolute(given != nullptr && *given != '\0' ? given : "bin").string();
}

std::vector<pid_t> processesWith(const std::string& nameAndValue, const std::string& program) {
  std::vector<pid_t> found;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", ignored)) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string environment = '\0' + readText(entry.path() / "environ");
    if (environment.find('\0' + nameAndValue + '\0') == std::string::npos) continue;
    const std::string command = readText(entry.path() / "cmdline");
    const std::string first = command.substr(0, command.find('\0'));
    if (!program.empty() && first.substr(first.find_last_of('/') + 1) != program) continue;
    found.push_back(std::stoi(name));
  }
  return found;
}

std::optional<double> cpuSecondsOf(pid_t pid) {
  const std::string stat = readText("/proc/" + std::to_string(pid) + "/stat");
  const std::size_t name = stat.find_last_of(')');
  if (name == std::string::npos) return std::nullopt;
  std::istringstream fields(stat.substr(name + 2));
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  double user = 0, system = 0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

std::string readText(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::size_t countLines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace rayshade
