// A slice of what tests/bench/oracle_fuzz.cc does at length: kernels against the exact answer.
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/oracle.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace rayshade {
namespace {

class Oracle : public testing::TestWithParam<std::string_view> {};

TEST_P(Oracle, FindsNoFault) {
  constexpr std::string_view kSlow[] = {"polygon", "torus", "blob", "heightfield", "pyramid"};
  const bool slow = std::find(std::begin(kSlow), std::end(kSlow), GetParam()) != std::end(kSlow);
  const std::uint64_t cases = slow ? 1000 : 10000;
  const OracleReport report = examine(GetParam(), 2026, 0, cases);
  EXPECT_EQ(report.failures, 0u) << (report.examples.empty() ? "" : report.examples[0]);
  EXPECT_GT(report.questions, cases / 2);  // it has looked at something
}

// Rays nearly along a generator, that fuzzing has found: hits of a cone that the exact ray passes, itself met again by a
// ray that leaves it along its side, hits that are missed.
TEST(OracleAgain, ConesAlongAGenerator) {
  constexpr std::uint64_t kCases[][2] = {{7, 212411},  {7, 239577},  {7, 598894},  {7, 85331},  {7, 381538},
                                         {7, 2421530}, {7, 4884111}, {2, 9114735}, {3, 312527}, {3, 8769939}};
  for (const auto& [seed, number] : kCases) {
    const OracleReport report = examine("cone", seed, number, 1);
    EXPECT_EQ(report.failures, 0u) << (report.examples.empty() ? "" : report.examples[0]);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Oracle, testing::ValuesIn(oracleClasses().begin(), oracleClasses().end()),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace rayshade
