// What the elementary functions cost against those of the C library (glibc chooses the fastest for this processor).
//
// CPU nanoseconds of a call, the best of many short runs that alternate, so that others on this machine disturb both.
// Decision 24 demands at most 1.5 times the library's time.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/elementary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <utility>
#include <vector>

#include "tests/support/random.h"

namespace rayshade {
namespace {

using Arguments = std::vector<std::pair<double, double>>;
struct Range {
  double low, high;
};

double cpuSeconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Function>
double nanoseconds(const Function& function, const Arguments& arguments) {
  constexpr int kRounds = 200;
  const double begin = cpuSeconds();
  double sum = 0;
  for (int round = 0; round < kRounds; ++round)
    for (const auto& [x, y] : arguments) sum += function(x, y);
  volatile double used = sum;
  (void)used;
  return (cpuSeconds() - begin) / kRounds / static_cast<double>(arguments.size()) * 1e9;
}

template <class Ours, class Library>
void compare(const char* name, Range x, Range y, const Ours& ours, const Library& library) {
  Random random(1);
  Arguments arguments;
  for (int i = 0; i < 1000; ++i)
    arguments.emplace_back(random.real(x.low, x.high), random.real(y.low, y.high));
  double a = 1e9, b = 1e9;
  for (int run = 0; run < 40; ++run) {
    a = std::min(a, nanoseconds(ours, arguments));
    b = std::min(b, nanoseconds(library, arguments));
  }
  std::printf("%-6s %10g ... %-8g %6.1f ns, library %6.1f ns, ratio %.2f\n", name, x.low, x.high, a, b,
              a / b);
}

#define COMPARE(name, ...)                                                  \
  for (const Range x : {__VA_ARGS__})                                       \
  compare(                                                                  \
      #name, x, {}, [](double of, double) { return elementary::name(of); }, \
      [](double of, double) { return std::name(of); })
#define COMPARE_OF_TWO(name, x, y)                                                    \
  compare(                                                                            \
      #name, x, y, [](double of, double and_) { return elementary::name(of, and_); }, \
      [](double of, double and_) { return std::name(of, and_); })

void compareAll() {
  COMPARE(exp, Range{-1, 1}, Range{-10, 1});
  COMPARE(expm1, Range{-1, 1}, Range{-10, 1});
  COMPARE(log, Range{0.1, 10}, Range{0.99, 1.01});
  COMPARE_OF_TWO(pow, (Range{0, 1}), (Range{0.3, 2}));
  COMPARE_OF_TWO(pow, (Range{0.01, 100}), (Range{-50, 50}));
  COMPARE(cbrt, Range{0, 100});
  COMPARE_OF_TWO(hypot, (Range{-1, 1}), (Range{-1, 1}));
  COMPARE(sin, Range{-1, 1}, Range{-100, 100}, Range{-1e6, 1e6}, Range{-1e15, 1e15});
  COMPARE(cos, Range{-1, 1}, Range{-100, 100}, Range{-1e6, 1e6}, Range{-1e15, 1e15});
  COMPARE(tan, Range{-1, 1}, Range{-100, 100});
  COMPARE(asin, Range{-1, 1}, Range{-0.5, 0.5});
  COMPARE(acos, Range{-1, 1}, Range{-0.5, 0.5});
  COMPARE(atan, Range{-1, 1}, Range{-10, 10});
  COMPARE_OF_TWO(atan2, (Range{-1, 1}), (Range{-1, 1}));
}

}  // namespace
}  // namespace rayshade

int main() { rayshade::compareAll(); }
