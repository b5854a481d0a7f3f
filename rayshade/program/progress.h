// A line that says how far a render is, for people: on a terminal only.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>

namespace rayshade {

inline double secondsNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

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
  explicit ProgressLine(bool wanted) : shown_(wanted && isatty(STDERR_FILENO)), begin_(secondsNow()) {}
  ~ProgressLine() { clear(); }

  void show(std::int32_t rows, std::int32_t allRows, std::uint64_t rays, const char* unit) {
    const double now = secondsNow();
    if (!shown_ || now - last_ < 0.1) return;
    last_ = now;
    const double spent = now - begin_;
    std::fprintf(stderr, "\r%3d %%  row %d of %d  %.2f M %s/s", 100 * rows / std::max(allRows, 1), rows,
                 allRows, 1e-6 * static_cast<double>(rays) / std::max(spent, 1e-9), unit);
    if (rows > 0) std::fprintf(stderr, "  %.0f s left", spent * (allRows - rows) / rows);
    std::fprintf(stderr, "\033[K");
    std::fflush(stderr);
    drawn_ = true;
  }
  void clear() {
    if (drawn_) std::fprintf(stderr, "\r\033[K");
    drawn_ = false;
  }

 private:
  bool shown_, drawn_ = false;
  double begin_, last_ = 0;
};

}  // namespace rayshade
