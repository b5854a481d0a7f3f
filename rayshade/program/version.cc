// The only file that knows the version; the Makefile gives it the commit, and compiles it anew when that is another.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/program/version.h"

#include <cstdio>

#include "rayshade/accel/simd.h"
#include "rayshade/base/arithmetic.h"

namespace rayshade {
namespace {

constexpr const char* kVersion = "1.0";

const char* nameOf(Processor processor) {
  switch (processor) {
    case Processor::avx512:
      return "AVX-512";
    case Processor::avx2:
      return "AVX2";
    case Processor::any:
      break;
  }
  return "no wide registers";
}

}  // namespace

std::string nameAndVersion(const std::string& program) { return program + " " + kVersion; }

std::string versionText(const std::string& program) {
  const std::string commit = RAYSHADE_COMMIT;
  char arithmetic[17];
  std::snprintf(arithmetic, sizeof arithmetic, "%016llx",
                static_cast<unsigned long long>(arithmeticFingerprint()));
  return nameAndVersion(program) + (commit.empty() ? "" : " (" + commit + ")") +
         ", for this processor: " + nameOf(thisProcessor()) + ", arithmetic " + arithmetic;
}

}  // namespace rayshade
