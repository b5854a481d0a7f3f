// Kernels against the exact answer, millions of times.
//
//   oracle_fuzz [--cases N] [--seed S] [--first K] [CLASS...]     all classes, 1 000 000 cases each, seed 1
//
// One line per class: cases, cases per second, questions, share decided with 256 bits, failures, worst distance of a hit.
// Failures are printed with all that is needed to repeat them: CLASS --seed S --first K --cases 1.
// What a failure is: tests/support/oracle/oracle.h.  Exit status 1 when there was one.
// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstring>

#include "tests/support/oracle/oracle.h"

namespace {

std::uint64_t numberIn(const char* text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text, text + std::strlen(text), value);
  if (error == std::errc() && *end == '\0') return value;
  std::fprintf(stderr, "oracle_fuzz: %s is no number\n", text);
  std::exit(2);
}

}  // namespace

int main(int argc, char** argv) {
  using rayshade::OracleReport;
  std::uint64_t cases = 1'000'000, seed = 1, first = 0;
  std::vector<std::string_view> classes;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    const bool more = i + 1 < argc;
    if (word == "--cases" && more) {
      cases = numberIn(argv[++i]);
    } else if (word == "--seed" && more) {
      seed = numberIn(argv[++i]);
    } else if (word == "--first" && more) {
      first = numberIn(argv[++i]);
    } else {
      classes.push_back(word);
    }
  }
  if (classes.empty()) classes.assign(rayshade::oracleClasses().begin(), rayshade::oracleClasses().end());

  std::printf("class\tseed\tcases\tcases/s\tquestions\tin 256 bits\tfailures\tworst distance [u M]\n");
  bool good = true;
  for (const std::string_view name : classes) {
    const auto begin = std::chrono::steady_clock::now();
    const OracleReport report = rayshade::examine(name, seed, first, cases);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    std::printf("%.*s\t%llu\t%llu\t%.0f\t%llu\t%.2g\t%llu\t%.2f\n", static_cast<int>(name.size()),
                name.data(), static_cast<unsigned long long>(seed),
                static_cast<unsigned long long>(report.cases), static_cast<double>(cases) / seconds,
                static_cast<unsigned long long>(report.questions),
                static_cast<double>(report.doubtful) / static_cast<double>(cases),
                static_cast<unsigned long long>(report.failures), report.worst);
    for (const std::string& example : report.examples) std::printf("  %s\n", example.c_str());
    std::fflush(stdout);
    good = good && report.failures == 0;
  }
  return good ? 0 : 1;
}
