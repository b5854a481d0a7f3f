// Ctrl-C and SIGTERM as a question that a loop can ask, so that files and tasks are put away in order.
//
// The second signal ends the program at once.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <stdexcept>

namespace rayshade {

class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

inline volatile std::sig_atomic_t& interruptionFlag() {
  static volatile std::sig_atomic_t flag = 0;  // a signal handler can reach nothing else
  return flag;
}

inline void listenForInterruption() {
  auto handler = [](int signal) {
    if (interruptionFlag() != 0) std::signal(signal, SIG_DFL);
    interruptionFlag() = 1;
  };
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
}

// Throws Interrupted when a signal has come.
inline void checkInterruption() {
  if (interruptionFlag() != 0) throw Interrupted();
}

}  // namespace rayshade
