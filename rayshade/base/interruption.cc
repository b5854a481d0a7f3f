// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/interruption.h"

#include <unistd.h>

#include <csignal>
#include <utility>

namespace rayshade {
namespace {

constexpr std::pair<int, const char*> kSignals[] = {
    {SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}};

volatile std::sig_atomic_t come = 0;  // a signal handler can reach nothing but a global variable

}  // namespace

void listenForInterruption() {
  for (const auto& [signal, name] : kSignals) {
    struct sigaction action {};
    if (sigaction(signal, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = [](int number) { come = number; };
    action.sa_flags = static_cast<int>(SA_RESETHAND);  // no SA_RESTART: who waits for input is to be woken
    sigaction(signal, &action, nullptr);
  }
}

bool interrupted() { return come != 0; }

std::string interruptionText() {
  for (const auto& [signal, name] : kSignals)
    if (signal == come) return std::string("interrupted by ") + name;
  return "not interrupted";
}

void checkInterruption() {
  if (interrupted()) throw Interrupted(interruptionText());
}

void dieOfInterruption() {
  const int signal = come;
  std::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  std::raise(signal);
  _exit(128 + signal);  // not reached
}

}  // namespace rayshade
