// How far a render is, for people: a line that changes on a terminal, a new line for each tenth elsewhere (a log, the pvm
// console), unless tenths go by faster than one can read.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <utility>

#include "rayshade/base/clock.h"
#include "rayshade/sampling/sampler.h"

namespace rayshade {

// A line that stays, for those who ask for it.
inline void sayLine(std::int32_t rows, std::int32_t allRows, std::int32_t width) {
  std::fprintf(stderr, "finished line %d of %d (%lld pixels)\n", rows, allRows,
               static_cast<long long>(rows) * width);
}

inline void warnOfNotFinite(std::uint64_t samples) {
  if (samples == 0) return;
  std::fprintf(stderr, "warning: the colours of %llu samples were no finite numbers: they are black\n",
               static_cast<unsigned long long>(samples));
}

class ProgressLine {
 public:
  using Clock = std::function<double()>;  // seconds
  explicit ProgressLine(bool wanted, bool terminal = isatty(STDERR_FILENO) == 1, Clock clock = steadySeconds)
      : wanted_(wanted), terminal_(terminal), clock_(std::move(clock)), begin_(clock_()), last_(begin_) {}
  ~ProgressLine() { clear(); }

  void show(const Completed& done) {
    if (!wanted_ || done.samples == 0) return;
    const double now = clock_(), spent = now - begin_;
    if (now - last_ < (terminal_ ? 0.1 : 1)) return;
    const double expected = static_cast<double>(std::max(done.expected, done.samples));
    const double share = static_cast<double>(done.samples) / expected;
    if (!terminal_ && 10 * share < tenths_ + 1) return;
    last_ = now;
    tenths_ = static_cast<int>(10 * share);
    std::fprintf(stderr, "%s%3.0f %%  row %d of %d  %.2f M samples/s  %.0f s left%s", terminal_ ? "\r" : "",
                 terminal_ ? 100 * share : 10.0 * tenths_, done.rows, done.allRows,
                 1e-6 * static_cast<double>(done.samples) / spent, spent * (1 - share) / share,
                 terminal_ ? "\033[K" : "\n");
    std::fflush(stderr);
    drawn_ = terminal_;
  }
  void clear() {
    if (drawn_) std::fprintf(stderr, "\r\033[K");
    drawn_ = false;
  }

 private:
  bool wanted_, terminal_, drawn_ = false;
  int tenths_ = 0;  // said
  Clock clock_;
  double begin_, last_;
};

}  // namespace rayshade
