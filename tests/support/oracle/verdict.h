// What was found of a case, and how it is counted and told.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "rayshade/base/archive.h"
#include "rayshade/shapes/shape.h"
#include "tests/support/oracle/exact_numbers.h"
#include "tests/support/oracle/oracle.h"

namespace rayshade {

inline constexpr double kBound = 16;  // [u M]

enum class Fault { none, phantom, missed, pointOff, selfHit };

struct Verdict {
  Fault fault = Fault::none;
  double t = 0;         // where
  double distance = 0;  // of a hit, the worst of them                                                   [u M]
  std::uint64_t questions = 0;
};

void count(OracleReport& report, const Verdict& verdict, const std::function<std::string()>& story);

// Decides with long double, and with 256 bits what that finds fault with.
template <class Look>
Verdict decide(OracleReport& report, std::uint64_t number, Look&& look) {
  const Verdict quick = look((long double)(0));
  if (quick.fault == Fault::none && quick.distance < kBound / 4 && number % 1024 != 0) return quick;
  ++report.doubtful;
  return look(exact::Exact(0));
}

// All that is needed to repeat the case; `shape` as encoded.
std::string story(std::string_view name, std::uint64_t seed, std::uint64_t number, const Bytes& shape,
                  const LocalRay& ray, const Verdict& verdict);
template <class S>
std::string story(std::string_view name, std::uint64_t seed, std::uint64_t number, const S& shape,
                  const LocalRay& ray, const Verdict& verdict) {
  return story(name, seed, number, encode(shape), ray, verdict);
}

// Looks at one case of a class.
using Examine = void(OracleReport&, std::string_view name, std::uint64_t seed, std::uint64_t number);
template <class S>
void examineShape(OracleReport& report, std::string_view name, std::uint64_t seed, std::uint64_t number);
Examine examineFan, examineSlab, examineVoxel, examinePyramid;

}  // namespace rayshade
