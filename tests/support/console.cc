// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/console.h"

#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "rayshade/base/clock.h"

namespace rayshade {

Console::Console(const std::vector<std::string>& arguments, const Program::Environment& environment) {
  pid_ = forkpty(&terminal_, nullptr, nullptr, nullptr);
  if (pid_ < 0) throw std::runtime_error("forkpty");
  if (pid_ == 0) becomeProgram(arguments, environment);
}

Console::~Console() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close(terminal_);
}

void Console::type(const std::string& line) {
  const std::string all = line + "\n";
  if (write(terminal_, all.data(), all.size()) != static_cast<ssize_t>(all.size()))
    throw std::runtime_error("terminal");
}

bool Console::read(double seconds) {
  pollfd wait{terminal_, POLLIN, 0};
  if (::poll(&wait, 1, static_cast<int>(1000 * seconds)) <= 0) return false;
  char block[4096];
  const ssize_t got = ::read(terminal_, block, sizeof block);
  if (got > 0) heard_.append(block, static_cast<std::size_t>(got));
  return got > 0;
}

std::string Console::hear(const std::string& text, double seconds) {
  const double end = steadySeconds() + seconds;
  std::size_t at;
  while ((at = heard_.find(text)) == std::string::npos && steadySeconds() < end) {
    if (!read(std::min(0.1, std::max(0.0, end - steadySeconds()))))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const std::size_t count = at == std::string::npos ? heard_.size() : at + text.size();
  const std::string said = heard_.substr(0, count);
  heard_.erase(0, count);
  return said;
}

bool Console::ends(double seconds) {
  for (const double end = steadySeconds() + seconds; steadySeconds() < end;) {
    read(0.02);  // a full terminal would keep it
    if (waitpid(pid_, nullptr, WNOHANG) == pid_) pid_ = 0;
    if (pid_ == 0) return true;
  }
  return false;
}

}  // namespace rayshade
